#pragma once
// Encoding and decoding of bulk messages: a header, and a payload of packed records that is cut
// into chunks.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <numeric>
#include <type_traits>
#include <vector>

#include "lcmtypes/codec/wire.hpp"

namespace kintsugi::codec {

static_assert(std::endian::native == std::endian::little,
              "records are sent as they are in memory, which must be little-endian");

using Counts = std::array<std::int32_t, 4>;

/// What the codec has to know of a bulk message:
///   WireType, kNumStrings                 its LCM type, and the number of its strings
///   kAlignment                            chunks are cut at multiples of it, bytes
///   kRecordsVersion                       of the packed records, if the LCM type has such a field
///   header_to_wire(), header_from_wire()  convert every field that is not bulk data
///   set_counts(), counts()                number of records of each bulk vector, in the LCM type
///   set_part(), first_byte()              place of the chunk in the payload, in the LCM type
///   check_header(), check_records()       throw when a field is out of its bounds
///   for_each_vector(message, f)           calls f with each bulk vector, in the payload's order
template <class Message>
struct Bulk;

/// True for the LCM types whose payload is packed records, and not an image.
template <class Wire>
concept HasRecords = requires(Wire wire) {
  wire.records_version;
};

/// For the LCM types in which the place of a chunk is given in bytes.
template <class Wire>
struct PlacedByByte {
  using WireType = Wire;
  static constexpr std::size_t kAlignment = 4;

  static void set_part(Wire& wire, std::int64_t first_byte, std::size_t num_bytes) {
    wire.first_byte = static_cast<std::int32_t>(first_byte);
    wire.num_bytes = static_cast<std::int32_t>(num_bytes);
  }
  static std::int64_t first_byte(const Check& /*check*/, const Wire& wire) {
    return wire.first_byte;
  }
};

template <class Vector>
constexpr std::int64_t record_bytes() {
  using Record = typename std::remove_cvref_t<Vector>::value_type;
  static_assert(std::is_trivially_copyable_v<Record>);
  return sizeof(Record);
}

template <class Message>
Counts count_records(const Message& message) {
  const Check check(Bulk<Message>::WireType::getTypeName());
  Counts counts{};
  std::size_t i = 0;
  Bulk<Message>::for_each_vector(message, [&](const auto& records) {
    const auto count = static_cast<std::int64_t>(records.size());
    check.range<std::int64_t>("number of records", count, 0, kMaxPayloadBytes);
    counts.at(i++) = static_cast<std::int32_t>(count);
  });
  return counts;
}

/// Bytes of the whole payload. @throws std::invalid_argument when that is out of bounds
template <class Message>
std::int64_t payload_bytes(const Counts& counts) {
  const Check check(Bulk<Message>::WireType::getTypeName());
  std::int64_t total = 0;
  std::size_t i = 0;
  Message empty;
  Bulk<Message>::for_each_vector(empty, [&](const auto& records) {
    const std::int32_t count = counts.at(i++);
    check.not_negative("number of records", count);
    total += count * record_bytes<decltype(records)>();
  });
  check.range<std::int64_t>("payload bytes", total, 0, kMaxPayloadBytes);
  return total;
}

template <class Message>
typename Bulk<Message>::WireType header_wire(const Message& message, const Counts& counts) {
  typename Bulk<Message>::WireType wire{};
  Bulk<Message>::header_to_wire(message, wire);
  if constexpr (HasRecords<typename Bulk<Message>::WireType>) {
    wire.records_version = Bulk<Message>::kRecordsVersion;
  }
  Bulk<Message>::set_counts(wire, counts);
  return wire;
}

/// Payload bytes in every chunk but the last.
template <class Message>
std::int64_t part_bytes(const typename Bulk<Message>::WireType& header,
                        std::size_t max_chunk_bytes) {
  const auto room = max_chunk_bytes - static_cast<std::size_t>(header.getEncodedSize());
  return static_cast<std::int64_t>(room / Bulk<Message>::kAlignment * Bulk<Message>::kAlignment);
}

/// Copies the payload's bytes from `first` on, as many as `part` holds.
template <class Message>
void copy_payload(const Message& message, std::int64_t first, Bytes& part) {
  std::int64_t start = 0;  // of the records in the payload
  const std::int64_t last = first + static_cast<std::int64_t>(part.size());
  Bulk<Message>::for_each_vector(message, [&](const auto& records) {
    const auto end =
        start + static_cast<std::int64_t>(records.size()) * record_bytes<decltype(records)>();
    const std::int64_t from = std::max(first, start);
    const std::int64_t to = std::min(last, end);
    if (from < to) {
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(records.data());
      std::copy(bytes + (from - start), bytes + (to - start), part.data() + (from - first));
    }
    start = end;
  });
}

}  // namespace kintsugi::codec

namespace kintsugi {

template <BulkMessage Message>
std::int64_t payload_bytes(const Message& message) {
  return codec::payload_bytes<Message>(codec::count_records(message));
}

template <BulkMessage Message>
std::int32_t num_chunks(const Message& message, std::size_t max_chunk_bytes) {
  using Traits = codec::Bulk<Message>;
  const codec::Check check(Traits::WireType::getTypeName());
  check.range("max_chunk_bytes", max_chunk_bytes, kMinMaxChunkBytes, std::size_t{1} << 24U);
  const codec::Counts counts = codec::count_records(message);
  Traits::check_header(check, message, counts);
  Traits::check_records(check, message);
  const std::int64_t total = codec::payload_bytes<Message>(counts);
  const std::int64_t part =
      codec::part_bytes<Message>(codec::header_wire(message, counts), max_chunk_bytes);
  return static_cast<std::int32_t>(std::max<std::int64_t>(1, (total + part - 1) / part));
}

template <BulkMessage Message>
Bytes encode_chunk(const Message& message, std::int64_t sequence, std::int32_t index,
                   std::size_t max_chunk_bytes) {
  const codec::Counts counts = codec::count_records(message);
  const std::int64_t total = codec::payload_bytes<Message>(counts);
  auto wire = codec::header_wire(message, counts);
  const std::int64_t part = codec::part_bytes<Message>(wire, max_chunk_bytes);
  const std::int64_t first = index * part;
  wire.sequence = sequence;
  wire.chunk_index = index;
  wire.num_chunks = static_cast<std::int32_t>(std::max<std::int64_t>(1, (total + part - 1) / part));
  wire.data.resize(static_cast<std::size_t>(std::min(part, total - first)));
  codec::copy_payload(message, first, wire.data);
  codec::Bulk<Message>::set_part(wire, first, wire.data.size());
  return codec::encode_wire(wire);
}

template <BulkMessage Message>
Chunk<Message> decode_chunk(ByteView data) {
  using Traits = codec::Bulk<Message>;
  using Wire = typename Traits::WireType;
  return codec::as_decode_error([&] {
    const codec::Check check(Wire::getTypeName());
    auto wire = codec::decode_wire<Wire>(data, Traits::kNumStrings, 1);
    // Before any size: records of another version have other sizes.
    if constexpr (codec::HasRecords<Wire>) {
      check.records_version(wire.records_version, Traits::kRecordsVersion);
    }
    Chunk<Message> chunk;
    chunk.sequence = wire.sequence;
    chunk.index = wire.chunk_index;
    chunk.count = wire.num_chunks;
    chunk.num_records = Traits::counts(wire);
    chunk.total_bytes = codec::payload_bytes<Message>(chunk.num_records);
    chunk.first_byte = Traits::first_byte(check, wire);
    Traits::header_from_wire(wire, chunk.header);
    Traits::check_header(check, chunk.header, chunk.num_records);

    const auto size = static_cast<std::int64_t>(wire.data.size());
    // Only the chunk of an empty payload may be empty.
    const std::int64_t max_count = std::max<std::int64_t>(1, chunk.total_bytes);
    check.range<std::int64_t>("num_chunks", chunk.count, 1, max_count);
    check.range("chunk_index", chunk.index, 0, chunk.count - 1);
    check.range<std::int64_t>("sequence", chunk.sequence, chunk.index, kMaxSequence);
    check.range<std::int64_t>("first byte", chunk.first_byte, 0, chunk.total_bytes);
    check.range<std::int64_t>("num_bytes", size, chunk.total_bytes > 0 ? 1 : 0,
                              chunk.total_bytes - chunk.first_byte);

    chunk.part = std::move(wire.data);
    wire.data.clear();
    wire.checksum = 0;
    wire.sequence = 0;
    wire.chunk_index = 0;
    Traits::set_part(wire, 0, 0);
    chunk.identity = codec::bytes_of(wire);
    return chunk;
  });
}

template <BulkMessage Message>
Message join(const std::vector<Chunk<Message>>& chunks) {
  using Traits = codec::Bulk<Message>;
  return codec::as_decode_error([&] {
    const codec::Check check(Traits::WireType::getTypeName());
    if (chunks.empty()) check.fail("chunks", 0, "at least one");
    const Chunk<Message>& front = chunks.front();
    std::int64_t joined = 0;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
      const Chunk<Message>& chunk = chunks[i];
      if (chunk.identity != front.identity) {
        check.fail("header of chunk", chunk.index, "that of the message's first chunk");
      }
      if (chunk.index != static_cast<std::int32_t>(i)) {
        check.fail("chunk_index", chunk.index, std::to_string(i));
      }
      if (chunk.first_byte != joined) {
        check.fail("first byte", chunk.first_byte, std::to_string(joined));
      }
      joined += static_cast<std::int64_t>(chunk.part.size());
    }
    if (joined != front.total_bytes) {
      check.fail("payload bytes", joined, std::to_string(front.total_bytes));
    }

    // Memory is allocated only now that as many bytes have been received as the header claims.
    Bytes payload;
    payload.reserve(static_cast<std::size_t>(joined));
    for (const auto& chunk : chunks) {
      payload.insert(payload.end(), chunk.part.begin(), chunk.part.end());
    }
    Message message = front.header;
    if constexpr (requires { message.sequence; }) message.sequence = front.sequence;
    if constexpr (requires { message.num_chunks; }) message.num_chunks = front.count;
    std::size_t i = 0;
    const std::uint8_t* from = payload.data();
    Traits::for_each_vector(message, [&](auto& records) {
      records.resize(static_cast<std::size_t>(front.num_records.at(i++)));
      const std::size_t size = records.size() * codec::record_bytes<decltype(records)>();
      if (size > 0) std::memcpy(static_cast<void*>(records.data()), from, size);
      from += size;
    });
    Traits::check_records(check, message);
    return message;
  });
}

}  // namespace kintsugi
