// Every message of the contract, one at a time: what is accepted can be encoded again.

#include "lcmtypes/codec/codec.hpp"
#include "tests/decoder_fuzz/require.hpp"

namespace kintsugi {
namespace {

using fuzzing::require;

template <SmallMessage Message>
void decode_small(ByteView data) {
  try {
    const Bytes sent = encode(decode<Message>(data));
    require(encode(decode<Message>(sent)) == sent, "a message is the same after a round trip");
  } catch (const DecodeError&) {
  }
}

template <BulkMessage Message>
void decode_bulk(ByteView data) {
  try {
    const Message message = join(std::vector{decode_chunk<Message>(data)});
    require(payload_bytes(message) <= static_cast<std::int64_t>(data.size()),
            "no more is made than has come");
    // One chunk again: a message of at most max_len bytes.
    const Bytes sent = encode_chunk(message, 0, 0, kDefaultMaxChunkBytes);
    const Message received = join(std::vector{decode_chunk<Message>(sent)});
    require(encode_chunk(received, 0, 0, kDefaultMaxChunkBytes) == sent,
            "a message is the same after a round trip");
  } catch (const DecodeError&) {
  }
}

}  // namespace
}  // namespace kintsugi

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi;  // NOLINT(google-build-using-namespace): the messages
  const ByteView message(data, size);
  decode_small<CameraPose>(message);
  decode_small<MapperStatus>(message);
  decode_small<SegmenterStatus>(message);
  decode_small<ViewerStatus>(message);
  decode_small<Heartbeat>(message);
  decode_small<ResendRequest>(message);
  decode_small<ChunksReplaced>(message);
  decode_small<SegmentQuery>(message);
  decode_small<DetectorStatus>(message);
  decode_small<ObjectDetection>(message);
  decode_small<ChangeReport>(message);
  decode_bulk<CloudSlice>(message);
  decode_bulk<SegmentUpdate>(message);
  decode_bulk<SegmentAnswer>(message);
  decode_bulk<RgbdFrameMessage>(message);
  decode_bulk<CameraView>(message);
  decode_bulk<KeyframeMessage>(message);
  decode_bulk<Snapshot>(message);
  return 0;
}
