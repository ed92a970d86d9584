#pragma once
// Safe use of the code that lcm-gen generates.
//
// The generated decoder trusts the message: it resizes an array to the count that it reads, be it
// two billion or negative, before it checks that the bytes are there, and it moves backwards over a
// string of negative length. Therefore the size of a message is compared with its counts before it
// is decoded. That is simple because all our types have the same shape:
//   fingerprint, checksum, other fields of fixed size (the last is the count, if there is an
//   array), strings, array.
// Then the checksum is compared, so that a message that was altered on its way is refused.

#include <cassert>
#include <cstddef>
#include <cstdint>

#include "lcmtypes/codec/check.hpp"
#include "lcmtypes/codec/checksum.hpp"

namespace kintsugi::codec {

struct WireShape {
  const char* type = "";
  std::int64_t fingerprint = 0;
  std::size_t fixed_bytes = 0;  ///< fingerprint and fixed-size fields
  int num_strings = 0;
  std::size_t bytes_per_count = 0;  ///< 0: there is no array
  bool checksum_optional = false;   ///< a checksum of 0 means that there is none
};

/// Checks the fingerprint, the size and the checksum of a message.
/// @throws std::invalid_argument when the message is of another type or version, its size is not
///   the one that its own counts and lengths give, or its checksum is wrong
void check_wire(const WireShape& shape, ByteView data);

/// True for types that programs of other people send, which need not compute a checksum.
template <class Wire>
inline constexpr bool kChecksumOptional = false;

template <class Wire>
WireShape wire_shape(int num_strings, std::size_t bytes_per_count) {
  // An empty message: each count is 0, each string has 5 bytes, its length and its terminator.
  const auto size = static_cast<std::size_t>(Wire{}.getEncodedSize());
  return {Wire::getTypeName(), Wire::getHash(), size - 5 * static_cast<std::size_t>(num_strings),
          num_strings,         bytes_per_count, kChecksumOptional<Wire>};
}

template <class Wire>
Wire decode_wire(ByteView data, int num_strings, std::size_t bytes_per_count) {
  static const WireShape shape = wire_shape<Wire>(num_strings, bytes_per_count);
  check_wire(shape, data);
  Wire wire{};
  const int used = wire.decode(data.data(), 0, static_cast<int>(data.size()));
  if (used != static_cast<int>(data.size())) {
    Check(shape.type).fail("size", data.size(), std::to_string(used) + " bytes");
  }
  return wire;
}

/// The encoded message, with the checksum that `wire` has.
template <class Wire>
Bytes bytes_of(const Wire& wire) {
  Bytes data(static_cast<std::size_t>(wire.getEncodedSize()));
  [[maybe_unused]] const int used = wire.encode(data.data(), 0, static_cast<int>(data.size()));
  assert(used == static_cast<int>(data.size()));
  return data;
}

/// The encoded message, with the correct checksum.
template <class Wire>
Bytes encode_wire(const Wire& wire) {
  Bytes data = bytes_of(wire);
  set_checksum(data);
  return data;
}

}  // namespace kintsugi::codec
