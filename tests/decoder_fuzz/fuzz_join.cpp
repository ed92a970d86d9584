// Several chunks: those that decode are joined, whether they fit together or not.

#include "lcmtypes/codec/codec.hpp"
#include "tests/decoder_fuzz/log_events.hpp"
#include "tests/decoder_fuzz/require.hpp"

namespace kintsugi {
namespace {

template <BulkMessage Message>
void join_all(const std::vector<fuzzing::LoggedMessage>& events) {
  std::vector<Chunk<Message>> chunks;
  std::int64_t received = 0;
  for (const fuzzing::LoggedMessage& event : events) {
    try {
      chunks.push_back(decode_chunk<Message>(event.data));
      received += static_cast<std::int64_t>(event.data.size());
    } catch (const DecodeError&) {
    }
  }
  try {
    const Message message = join(chunks);
    fuzzing::require(payload_bytes(message) <= received, "no more is made than has come");
    (void)num_chunks(message, kDefaultMaxChunkBytes);  // throws when it could not be sent
  } catch (const DecodeError&) {
  }
}

}  // namespace
}  // namespace kintsugi

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto events = kintsugi::fuzzing::read_events({data, size});
  kintsugi::join_all<kintsugi::CloudSlice>(events);
  kintsugi::join_all<kintsugi::SegmentUpdate>(events);
  kintsugi::join_all<kintsugi::SegmentAnswer>(events);
  kintsugi::join_all<kintsugi::RgbdFrameMessage>(events);
  kintsugi::join_all<kintsugi::CameraView>(events);
  kintsugi::join_all<kintsugi::KeyframeMessage>(events);
  kintsugi::join_all<kintsugi::Snapshot>(events);
  return 0;
}
