#pragma once
// Between the plain structs of messages.hpp and the bytes on the bus, checked in both directions.
//
// A small message is one LCM message: encode(), decode<CameraPose>().
// A bulk message (BulkMessage below) is a header and a payload of packed records, cut into chunks
// that each fit one datagram: num_chunks(), encode_chunk(), decode_chunk<CloudSlice>(), join().
//
// Decoding trusts nothing: every byte of the message must be accounted for, counts are compared
// with the message's size before anything is allocated for them, and the message must have its
// checksum.

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

/// A message from outside that cannot be used; what() names type, field, value and bound.
class DecodeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class T>
concept SmallMessage = std::same_as<T, CameraPose> || std::same_as<T, MapperStatus> ||
    std::same_as<T, SegmenterStatus> || std::same_as<T, ViewerStatus> ||
    std::same_as<T, Heartbeat> || std::same_as<T, ResendRequest> || std::same_as<T, SegmentQuery>;

template <class T>
concept BulkMessage = std::same_as<T, CloudSlice> || std::same_as<T, SegmentUpdate> ||
    std::same_as<T, SegmentAnswer> || std::same_as<T, RgbdFrameMessage> ||
    std::same_as<T, Snapshot>;

// Bounds that both sides agree on. A message outside them is refused, sent or received.
inline constexpr std::int64_t kMaxPayloadBytes = std::int64_t{1} << 30;  ///< of a bulk message
inline constexpr std::int64_t kMaxSequence = std::int64_t{1} << 48;
inline constexpr std::size_t kMaxStringBytes = 1024;
inline constexpr std::size_t kMaxResendRanges = 1024;
inline constexpr std::size_t kMaxQueriedIds = 4096;
inline constexpr double kMaxQueryRadius_m = 100.0;
inline constexpr float kMinResolution_m = 1e-4F;
inline constexpr float kMaxResolution_m = 10.0F;
inline constexpr int kMaxImageSide_px = 16384;

/// Largest encoded chunk that is published by default: one datagram on loopback.
inline constexpr std::size_t kDefaultMaxChunkBytes = 60'000;
/// Smallest limit that leaves room for a header with the longest strings.
inline constexpr std::size_t kMinMaxChunkBytes = 1'400;

/// `text` as a field may hold it: control characters become spaces, and what is too long is cut.
/// For texts from outside, such as the reason of a system error.
std::string fitting_text(std::string text);

/// The LCM message of `message`. Throws std::invalid_argument naming a field out of its bounds.
template <SmallMessage Message>
Bytes encode(const Message& message);

/// The struct in `data`, which came from the bus or a log. Throws DecodeError.
template <SmallMessage Message>
Message decode(ByteView data);

/// One received part of a bulk message.
template <BulkMessage Message>
struct Chunk {
  std::int64_t sequence = 0;  ///< of the chunk, in (session, channel)
  std::int32_t index = 0;     ///< of the chunk in its message
  std::int32_t count = 1;     ///< chunks in the message
  Message header;             ///< every field that is not bulk data
  /// Number of records of each bulk vector, in the order of the struct's fields; unused: 0.
  std::array<std::int32_t, 4> num_records{};
  std::int64_t total_bytes = 0;  ///< of the message's payload
  std::int64_t first_byte = 0;   ///< place of this part in the payload
  Bytes part;                    ///< this part of the payload
  Bytes identity;                ///< the encoded header: equal in all chunks of one message
};

/// Bytes of all bulk data of `message`.
template <BulkMessage Message>
std::int64_t payload_bytes(const Message& message);

/// Number of chunks of `message` when no chunk may be larger than `max_chunk_bytes`; >= 1.
/// Throws std::invalid_argument when a field of `message`, or the limit, is out of its bounds.
template <BulkMessage Message>
std::int32_t num_chunks(const Message& message, std::size_t max_chunk_bytes);

/// The LCM message of chunk `index` of `message`, under the sequence number `sequence`.
/// `message` has passed num_chunks() with the same limit.
template <BulkMessage Message>
Bytes encode_chunk(const Message& message, std::int64_t sequence, std::int32_t index,
                   std::size_t max_chunk_bytes);

/// The chunk in `data`, which came from the bus or a log. Throws DecodeError.
template <BulkMessage Message>
Chunk<Message> decode_chunk(ByteView data);

/// The message whose chunks are `chunks`, complete and in order of their index.
/// Throws DecodeError when they do not fit together or a record is out of its bounds.
template <BulkMessage Message>
Message join(const std::vector<Chunk<Message>>& chunks);

}  // namespace kintsugi
