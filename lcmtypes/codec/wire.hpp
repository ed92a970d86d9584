#pragma once
// Around the code that lcm-gen makes.
//
// Its decoder believes the message: it resizes an array to the count it reads, two billion or
// negative, before it looks whether the bytes are there, and it moves backwards over a string of
// negative length. So the size of a message is checked against its counts before it is decoded.
// That is simple because every type of ours has the same shape:
//   fingerprint, fixed-size fields (the last is the count, if there is an array), strings, array.

#include <cassert>
#include <cstddef>
#include <cstdint>

#include "lcmtypes/codec/check.hpp"

namespace kintsugi::codec {

struct WireShape {
  const char* type = "";
  std::int64_t fingerprint = 0;
  std::size_t fixed_bytes = 0;  ///< fingerprint and fixed-size fields
  int num_strings = 0;
  std::size_t bytes_per_count = 0;  ///< 0: there is no array
};

/// Throws std::invalid_argument unless `data` has exactly the size that its own lengths say.
void check_wire(const WireShape& shape, ByteView data);

template <class Wire>
WireShape wire_shape(int num_strings, std::size_t bytes_per_count) {
  // With every count zero and every string empty (a length and a terminator).
  const auto size = static_cast<std::size_t>(Wire{}.getEncodedSize());
  return {Wire::getTypeName(), Wire::getHash(), size - 5 * static_cast<std::size_t>(num_strings),
          num_strings, bytes_per_count};
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

template <class Wire>
Bytes encode_wire(const Wire& wire) {
  Bytes data(static_cast<std::size_t>(wire.getEncodedSize()));
  [[maybe_unused]] const int used = wire.encode(data.data(), 0, static_cast<int>(data.size()));
  assert(used == static_cast<int>(data.size()));
  return data;
}

}  // namespace kintsugi::codec
