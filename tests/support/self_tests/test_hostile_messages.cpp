#include <algorithm>
#include <map>
#include <set>

#include <gmock/gmock.h>

#include "lcmtypes/channels.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/hostile_messages.hpp"

namespace kintsugi::testing {
namespace {

using Kind = HostileMessages::Kind;
constexpr int kMessages = 5'100;  // 100 of each kind on each channel

/// The message is dropped by the decoder of its channel.
bool is_refused(const HostileMessages::Message& message) {
  const std::string& channel = message.channel;
  try {
    if (channel == channels::kCloudSlice) decode_chunk<CloudSlice>(message.data);
    if (channel == channels::kSegmentUpdate) decode_chunk<SegmentUpdate>(message.data);
    if (channel == channels::kSegmentQuery) decode<SegmentQuery>(message.data);
    if (channel == channels::kSegmentAnswer) decode_chunk<SegmentAnswer>(message.data);
    if (channel == channels::kKeyframe) decode_chunk<KeyframeMessage>(message.data);
    if (channel == channels::kCameraView) decode_chunk<CameraView>(message.data);
    if (channel == channels::kSnapshot) decode_chunk<Snapshot>(message.data);
    if (channel == channels::kCameraPose) decode<CameraPose>(message.data);
    if (channel == channels::kMapperStatus) decode<MapperStatus>(message.data);
    if (channel == channels::kSegmenterStatus) decode<SegmenterStatus>(message.data);
    if (channel == channels::kViewerStatus) decode<ViewerStatus>(message.data);
    if (channel == channels::kDetectorStatus) decode<DetectorStatus>(message.data);
    if (channel == channels::kObjectDetection) decode<ObjectDetection>(message.data);
    if (channel == channels::kChangeReport) decode<ChangeReport>(message.data);
    if (channel == channels::kHeartbeat) decode<Heartbeat>(message.data);
    if (channel == channels::kResendRequest) decode<ResendRequest>(message.data);
  } catch (const DecodeError&) {
    return true;
  }
  return channel == channels::kRgbdFrame;  // need not have a checksum
}

TEST(HostileMessages, AreOfEveryKindOnEveryChannel) {
  HostileMessages hostile(1);
  std::map<std::pair<std::string, Kind>, int> counts;
  for (int i = 0; i < kMessages; ++i) {
    const HostileMessages::Message message = hostile.next();
    ++counts[{message.channel, message.kind}];
  }
  EXPECT_EQ(counts.size(), 17U * HostileMessages::kKinds.size());
  for (const auto& [what, count] : counts) EXPECT_EQ(count, 100) << what.first;
}

TEST(HostileMessages, AreAllRefusedByTheDecoders) {
  HostileMessages hostile(2);
  for (int i = 0; i < kMessages; ++i) {
    const HostileMessages::Message message = hostile.next();
    ASSERT_TRUE(is_refused(message)) << message.channel << ", message " << i;
  }
}

TEST(HostileMessages, HaveManySizesUpToTheBound) {
  HostileMessages hostile(3, 1'000);
  std::set<std::size_t> sizes;
  for (int i = 0; i < kMessages; ++i) {
    const HostileMessages::Message message = hostile.next();
    if (message.kind != Kind::kRandom) continue;
    EXPECT_LE(message.data.size(), 1'000U);
    sizes.insert(message.data.size());
  }
  EXPECT_GT(sizes.size(), 100U);
}

TEST(HostileMessages, AreTheSameForTheSameSeed) {
  HostileMessages first(4);
  HostileMessages again(4);
  HostileMessages other(5);
  int different = 0;
  for (int i = 0; i < 300; ++i) {
    const Bytes data = first.next().data;
    EXPECT_EQ(again.next().data, data);
    different += other.next().data == data ? 0 : 1;
  }
  EXPECT_GT(different, 290);
}

TEST(HostileMessages, AreMadeFromWhatWasLearned) {
  HostileMessages hostile(6);
  const Bytes learned(5'000, 0xab);
  hostile.learn("SOMEBODY_ELSES", learned);
  for (int i = 0; i < 200; ++i) hostile.learn(channels::kCameraPose, learned);
  for (int i = 0; i < kMessages; ++i) {
    const HostileMessages::Message message = hostile.next();
    ASSERT_NE(message.channel, "SOMEBODY_ELSES");
    if (message.channel != channels::kCameraPose || message.kind != Kind::kMutated) continue;
    EXPECT_NE(message.data, learned);
    // At most four changes of at most 16 bytes each.
    const auto others = std::ssize(message.data) - std::ranges::count(message.data, 0xab);
    EXPECT_LE(others, 4 * 16);
  }
}

}  // namespace
}  // namespace kintsugi::testing
