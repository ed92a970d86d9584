// Which session of a log a run continues.

#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "mapper/session/mapped_frames.hpp"
#include "mapper/session/resumption.hpp"
#include "tests/support/example_messages.hpp"
#include "tests/support/temporary_folder.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class ResumptionTest : public ::testing::Test {
 protected:
  SessionStore::Config log(bool resume) const {
    SessionStore::Config config;
    config.path = folder_ / "run.lcm";
    config.resume = resume;
    return config;
  }

  const kintsugi::testing::TemporaryFolder folder_;
};

TEST_F(ResumptionTest, ContinuesTheLastRunOfTheLog) {
  {
    SessionStore store(log(false));
    Resumption run(store, {.options = {}, .session = 7});
    EXPECT_EQ(run.session(), 7);
  }
  SessionStore store(log(true));
  ASSERT_EQ(store.sessions().size(), 1U);
  Resumption run(store, {.options = {}, .session = 7});
  EXPECT_EQ(run.session(), 7);
  EXPECT_EQ(run.ended_session(), nullptr);
  EXPECT_THAT([&] { Resumption(store, {.options = {}, .session = 9}); },
              ThrowsMessage<std::runtime_error>(HasSubstr("the session to resume is 7")));
}

TEST_F(ResumptionTest, ContinuesARunWithOptionsThatAreNoUtf8) {
  const MappingOptions options{{"--map-name", "r\xe9"}};
  {
    SessionStore store(log(false));
    const Resumption run(store, {.options = options, .session = 7});
  }
  SessionStore store(log(true));
  EXPECT_EQ(Resumption(store, {.options = options}).session(), 7);
  EXPECT_THAT(
      [&] {
        Resumption(store, {.options = {{"--map-name", "s\xe9"}}});
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("--map-name is")));
}

TEST_F(ResumptionTest, KnowsWhichFramesWereFusedAndWhichOnlyTracked) {
  {
    SessionStore store(log(false));
    const Resumption run(store, {.options = {}, .session = 7});
    EXPECT_EQ(run.was_fused(100), std::nullopt);
    CameraPose pose = kintsugi::testing::example_camera_pose();
    pose.session = 7;
    for (pose.utime = 100; pose.utime <= 300; pose.utime += 100) {
      if (pose.utime == 200) {
        store.add(kTrackedOnlyChannel, encode_mapped_frames(7, {&pose.utime, 1}));
      }
      store.add(channels::kCameraPose, encode(pose));
    }
    // Killed before the pose was stored: the frame was mapped nevertheless.
    store.add(kTrackedOnlyChannel, encode_mapped_frames(7, std::vector<std::int64_t>{400}));
  }
  SessionStore store(log(true));
  const Resumption run(store, {.options = {}});
  EXPECT_EQ(run.was_fused(100), true);
  EXPECT_EQ(run.was_fused(200), false);
  EXPECT_EQ(run.was_fused(300), true);
  EXPECT_EQ(run.was_fused(400), false);
  EXPECT_EQ(run.was_fused(500), std::nullopt);
  EXPECT_EQ(run.last_mapped_utime(), 400);
}

/// A recording without frames.
struct EmptyRecording : FrameSource {
  std::optional<RgbdFrame> next() override { return std::nullopt; }
  SourceStatus status() const override {
    SourceStatus status;
    status.frames_total = 0;
    return status;
  }
};

TEST_F(ResumptionTest, BeginsAnewWhereGuestsHadJoined) {
  {
    SessionStore store(log(false));
    const Resumption run(store, {.options = {}, .session = 7});
    MapperStatus status = kintsugi::testing::example_mapper_status();
    status.session = 7;
    status.guests = 1;
    store.add(channels::kMapperStatus, encode(status));
  }
  SessionStore store(log(true));
  Resumption run(store, {.options = {}});
  EXPECT_EQ(run.session(), 7);
  auto source = run.attach(std::make_unique<EmptyRecording>());
  EXPECT_GT(run.session(), 7) << "what guests sent cannot be repeated";
  EXPECT_EQ(run.last_mapped_utime(), -1);
  EXPECT_NE(dynamic_cast<EmptyRecording*>(source.get()), nullptr) << "from its beginning";
}

TEST_F(ResumptionTest, FindsTheKeyframesThatWereSent) {
  {
    SessionStore store(log(false));
    const Resumption run(store, {.options = {}, .session = 7});
    KeyframeMessage keyframe = kintsugi::testing::example_keyframe(5);
    keyframe.session = 7;
    store.stream(channels::kKeyframe, 7)
        .add(0, encode_chunk(keyframe, 0, 0, kDefaultMaxChunkBytes));
  }
  SessionStore store(log(true));
  const Resumption run(store, {.options = {}});
  EXPECT_EQ(store.stream(channels::kKeyframe, 7).next_sequence(), 1);
  EXPECT_TRUE(store.stream(channels::kKeyframe, 7).find(0));
}

}  // namespace
}  // namespace kintsugi::mapper
