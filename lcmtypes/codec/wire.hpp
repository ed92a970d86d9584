#pragma once
// Around the code that lcm-gen makes.
//
// Its decoder believes the message: it resizes an array to the count it reads, two billion or
// negative, before it looks whether the bytes are there, and it moves backwards over a string of
// negative length. So the size of a message is checked against its counts before it is decoded.
// That is simple because every type of ours has the same shape:
//   fingerprint, checksum, other fixed-size fields (the last is the count, if there is an array),
//   strings, array.
// Behind the right size the checksum is compared, so that a message which was valid once and has
// changed since is refused and not believed.

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
  bool checksum_optional = false;   ///< 0 says that none is given
};

/// Throws std::invalid_argument unless `data` has exactly the size that its own lengths say, and
/// the checksum it claims.
void check_wire(const WireShape& shape, ByteView data);

/// Whether messages of a type come from people who need not compute a checksum.
template <class Wire>
inline constexpr bool kChecksumOptional = false;

template <class Wire>
WireShape wire_shape(int num_strings, std::size_t bytes_per_count) {
  // With every count zero and every string empty (a length and a terminator).
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

/// The bytes of `wire` as they lie on the bus, whatever its checksum.
template <class Wire>
Bytes bytes_of(const Wire& wire) {
  Bytes data(static_cast<std::size_t>(wire.getEncodedSize()));
  [[maybe_unused]] const int used = wire.encode(data.data(), 0, static_cast<int>(data.size()));
  assert(used == static_cast<int>(data.size()));
  return data;
}

/// The message of `wire`, with its checksum.
template <class Wire>
Bytes encode_wire(const Wire& wire) {
  Bytes data = bytes_of(wire);
  set_checksum(data);
  return data;
}

}  // namespace kintsugi::codec
