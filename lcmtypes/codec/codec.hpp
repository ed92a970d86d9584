#pragma once
// Converts the structs of messages.hpp to the bytes of LCM messages and back. Both directions check
// every field.
//
// A small message is one LCM message: encode(), decode<CameraPose>().
// A bulk message (BulkMessage below) is a header and a payload of packed records or images, cut
// into chunks of one LCM message each: num_chunks(), encode_chunk(), decode_chunk<CloudSlice>(),
// join().
//
// Decoding trusts nothing: a message must have exactly the size that its counts give, and the right
// checksum; counts are compared with the size before memory is allocated for them. Messages of
// another version of a type, and records of another layout, are refused with an error that says so.

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

/// A received message that cannot be used. what() names type, field, value and what was expected.
class DecodeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class T>
concept SmallMessage = std::same_as<T, CameraPose> || std::same_as<T, MapperStatus> ||
    std::same_as<T, SegmenterStatus> || std::same_as<T, ViewerStatus> ||
    std::same_as<T, DetectorStatus> || std::same_as<T, Heartbeat> ||
    std::same_as<T, ResendRequest> || std::same_as<T, ChunksReplaced> ||
    std::same_as<T, SegmentQuery> || std::same_as<T, ObjectDetection> ||
    std::same_as<T, ChangeReport>;

template <class T>
concept BulkMessage = std::same_as<T, CloudSlice> || std::same_as<T, SegmentUpdate> ||
    std::same_as<T, SegmentAnswer> || std::same_as<T, RgbdFrameMessage> ||
    std::same_as<T, CameraView> || std::same_as<T, KeyframeMessage> || std::same_as<T, Snapshot>;

// Bounds of the contract. A message outside of them is neither sent nor accepted.
inline constexpr std::int64_t kMaxPayloadBytes = std::int64_t{1} << 30;  ///< of a bulk message
inline constexpr std::int64_t kMaxSequence = std::int64_t{1} << 48;
inline constexpr std::size_t kMaxStringBytes = 1024;
/// Of the two names in a keyframe, which share a chunk of the smallest size with a long header.
inline constexpr std::size_t kMaxJoinNameBytes = 256;
inline constexpr std::size_t kMaxResendRanges = 1024;
inline constexpr std::size_t kMaxQueriedIds = 4096;
inline constexpr double kMaxQueryRadius_m = 100.0;
inline constexpr float kMinResolution_m = 1e-4F;
inline constexpr float kMaxResolution_m = 10.0F;
inline constexpr int kMaxImageSide_px = 16384;

/// Largest encoded chunk by default: it fits one datagram on the loopback interface.
inline constexpr std::size_t kDefaultMaxChunkBytes = 60'000;
/// Smallest limit of an encoded chunk. It leaves room for a header with the longest strings, and
/// fits one Ethernet frame.
inline constexpr std::size_t kMinMaxChunkBytes = 1'400;

/// Makes `text` a valid text of a message: control characters become spaces, and a long text is
/// cut. For texts that are not ours, such as that of a system error.
std::string fitting_text(std::string text);

/// Encodes a message. @throws std::invalid_argument naming the field that is out of its bounds
template <SmallMessage Message>
Bytes encode(const Message& message);

/// Decodes a message from the bus or a log. @throws DecodeError
template <SmallMessage Message>
Message decode(ByteView data);

/// One received part of a bulk message.
template <BulkMessage Message>
struct Chunk {
  std::int64_t sequence = 0;  ///< of the chunk, in (session, channel)
  std::int32_t index = 0;     ///< of the chunk in its message
  std::int32_t count = 1;     ///< chunks in the message
  Message header;             ///< every field that is not bulk data
  /// Number of records of each bulk vector, in the order of the payload; unused: 0.
  std::array<std::int32_t, 4> num_records{};
  std::int64_t total_bytes = 0;  ///< of the message's payload
  std::int64_t first_byte = 0;   ///< place of this part in the payload
  Bytes part;                    ///< the bytes of the payload that this chunk carries
  Bytes identity;                ///< the encoded header: equal in all chunks of one message
};

/// Bytes of the whole payload of `message`.
template <BulkMessage Message>
std::int64_t payload_bytes(const Message& message);

/// Number of chunks of `message` when no chunk may be larger than `max_chunk_bytes`; >= 1.
/// @throws std::invalid_argument when a field of `message`, or the limit, is out of its bounds
template <BulkMessage Message>
std::int32_t num_chunks(const Message& message, std::size_t max_chunk_bytes);

/// Encodes chunk `index` of `message`, with the sequence number `sequence`. num_chunks() must have
/// accepted `message` with the same limit.
template <BulkMessage Message>
Bytes encode_chunk(const Message& message, std::int64_t sequence, std::int32_t index,
                   std::size_t max_chunk_bytes);

/// Decodes a chunk from the bus or a log. @throws DecodeError
template <BulkMessage Message>
Chunk<Message> decode_chunk(ByteView data);

/// Joins all the chunks of a message, which are in the order of their index.
/// @throws DecodeError when they do not fit together, or a record is out of its bounds
template <BulkMessage Message>
Message join(const std::vector<Chunk<Message>>& chunks);

}  // namespace kintsugi
