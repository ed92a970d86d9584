#include "tests/support/hostile_messages.hpp"

#include <algorithm>
#include <cmath>

#include "lcmtypes/channels.hpp"
#include "tests/support/example_messages.hpp"

namespace kintsugi::testing {
namespace {

constexpr std::size_t kFingerprintBytes = 8;
constexpr std::size_t kMaxKept = 64;  // valid messages of a channel

template <BulkMessage Message>
std::vector<Bytes> chunks_of(const Message& message, std::size_t max_chunk_bytes) {
  std::vector<Bytes> chunks(static_cast<std::size_t>(num_chunks(message, max_chunk_bytes)));
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const auto index = static_cast<std::int32_t>(i);
    chunks[i] = encode_chunk(message, index, index, max_chunk_bytes);
  }
  return chunks;
}

std::map<std::string, std::vector<Bytes>> examples() {
  constexpr std::size_t kSmall = 2'000;
  return {{channels::kCloudSlice, chunks_of(example_slice(200), kSmall)},
          {channels::kCameraPose, {encode(example_camera_pose())}},
          {channels::kRgbdFrame, chunks_of(example_frame(3'000, 1'500), kSmall)},
          {channels::kSegmentUpdate, chunks_of(example_update(500), kSmall)},
          {channels::kSegmentQuery, {encode(example_query())}},
          {channels::kSegmentAnswer, chunks_of(example_answer(20), kSmall)},
          {channels::kKeyframe, chunks_of(example_keyframe(90), kSmall)},
          {channels::kCameraView, chunks_of(example_view(3'000), kSmall)},
          {channels::kSnapshot, chunks_of(example_snapshot(3'000), kSmall)},
          {channels::kMapperStatus, {encode(example_mapper_status())}},
          {channels::kSegmenterStatus, {encode(example_segmenter_status())}},
          {channels::kViewerStatus, {encode(example_viewer_status())}},
          {channels::kDetectorStatus, {encode(example_detector_status())}},
          {channels::kObjectDetection, {encode(example_detection())}},
          {channels::kChangeReport, {encode(example_change())}},
          {channels::kHeartbeat, {encode(example_heartbeat())}},
          {channels::kResendRequest, {encode(example_resend_request())}}};
}

}  // namespace

HostileMessages::HostileMessages(std::uint64_t seed, std::size_t max_bytes)
    : max_bytes_(max_bytes), random_(seed), valid_(examples()), channel_(valid_.begin()) {}

void HostileMessages::learn(const std::string& channel, ByteView data) {
  const auto found = valid_.find(channel);
  if (found == valid_.end() || data.empty()) return;
  std::vector<Bytes>& kept = found->second;
  const std::size_t place = learned_[channel]++ % kMaxKept;
  if (place >= kept.size()) kept.emplace_back();
  kept[place].assign(data.begin(), data.end());
}

HostileMessages::Message HostileMessages::next() {
  const auto& [channel, valid] = *channel_;
  Message message{channel, kKinds[kind_], {}};
  switch (message.kind) {
    case Kind::kRandom:
      message.data = random_bytes(random_size());
      break;
    case Kind::kRandomBehindFingerprint:
      message.data = random_bytes(kFingerprintBytes + random_size());
      std::copy_n(valid.front().begin(), kFingerprintBytes, message.data.begin());
      break;
    case Kind::kMutated:
      message.data = mutated(valid[below(valid.size())]);
      break;
  }
  if (++channel_ == valid_.end()) {
    channel_ = valid_.begin();
    kind_ = (kind_ + 1) % kKinds.size();
  }
  return message;
}

std::size_t HostileMessages::below(std::size_t bound) {
  return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random_);
}

/// Uniform in the logarithm: most messages are small, and a few fill a datagram.
std::size_t HostileMessages::random_size() {
  std::uniform_real_distribution<double> logarithm(0.0, std::log(static_cast<double>(max_bytes_)));
  return static_cast<std::size_t>(std::exp(logarithm(random_)));
}

Bytes HostileMessages::random_bytes(std::size_t size) {
  Bytes bytes(size);
  std::ranges::generate(bytes, [this] { return static_cast<std::uint8_t>(random_()); });
  return bytes;
}

Bytes HostileMessages::mutated(const Bytes& valid) {
  Bytes data = valid;
  const std::size_t times = 1 + below(4);
  for (std::size_t i = 0; i < times || data == valid; ++i) mutate_once(data);
  return data;
}

void HostileMessages::mutate_once(Bytes& data) {
  if (data.empty()) data = random_bytes(1);
  const std::size_t place = below(data.size());
  const auto at = data.begin() + static_cast<std::ptrdiff_t>(place);
  const std::size_t count = std::min<std::size_t>(1 + below(16), data.size() - place);
  const auto end = at + static_cast<std::ptrdiff_t>(count);
  switch (below(6)) {
    case 0:  // one bit
      *at = static_cast<std::uint8_t>(*at ^ 1U << below(8));
      break;
    case 1:  // a number as large, or as small, as it can be
      std::fill(at, end, static_cast<std::uint8_t>(below(2) == 0 ? 0xff : 0));
      break;
    case 2:
      std::ranges::copy(random_bytes(count), at);
      break;
    case 3:  // cut off
      data.resize(place);
      break;
    case 4:
      data.erase(at, end);
      break;
    default: {  // some bytes twice
      const Bytes again(at, end);
      data.insert(end, again.begin(), again.end());
    }
  }
}

}  // namespace kintsugi::testing
