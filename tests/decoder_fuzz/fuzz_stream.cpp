// Chunks and heartbeats with any content in any order, in a receiver of a stream.

#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "tests/decoder_fuzz/log_events.hpp"
#include "tests/decoder_fuzz/require.hpp"

namespace kintsugi {
namespace {

constexpr std::size_t kMaxPendingBytes = 4'096;

template <BulkMessage Message>
StreamSubscriberConfig<Message> small_bounds() {
  StreamSubscriberConfig<Message> config;
  config.max_pending_bytes = kMaxPendingBytes;
  config.max_sessions = 3;
  config.max_gaps_per_session = 4;
  return config;
}

template <BulkMessage Message>
void receive(const char* channel, const std::vector<fuzzing::LoggedMessage>& events) {
  const auto config = small_bounds<Message>();
  std::int64_t messages = 0;
  StreamSubscriber<Message> subscriber(
      channel, [&](const Message&) { ++messages; }, {}, config);
  double now_s = 0.0;
  for (const fuzzing::LoggedMessage& event : events) {
    (void)subscriber.handle(event.channel, event.data);
    for (const ResendRequest& request : subscriber.poll(now_s += 0.3)) {
      fuzzing::require(encode(request).size() <= config.max_request_bytes,
                       "a request fits one datagram");
    }
  }
  const StreamCounts counts = subscriber.counts();
  fuzzing::require(counts.chunks_missing >= 0, "what is missing can be counted");
  fuzzing::require(messages <= counts.chunks_received, "a message comes of chunks");
}

}  // namespace
}  // namespace kintsugi

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi;  // NOLINT(google-build-using-namespace): the messages
  const auto events = fuzzing::read_events({data, size});
  receive<CloudSlice>(channels::kCloudSlice, events);
  receive<SegmentUpdate>(channels::kSegmentUpdate, events);
  receive<SegmentAnswer>(channels::kSegmentAnswer, events);
  receive<RgbdFrameMessage>(channels::kRgbdFrame, events);
  receive<CameraView>(channels::kCameraView, events);
  receive<KeyframeMessage>(channels::kKeyframe, events);
  receive<Snapshot>(channels::kSnapshot, events);
  return 0;
}
