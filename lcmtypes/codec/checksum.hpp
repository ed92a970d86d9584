#pragma once
// Every message of ours carries the CRC-32 (zlib's) of its own bytes, in the four bytes behind
// LCM's fingerprint, big-endian as LCM writes integers. While it is computed those four are zero.

#include <cstddef>
#include <cstdint>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::codec {

inline constexpr std::size_t kChecksumPlace = 8;
inline constexpr std::size_t kChecksumEnd = kChecksumPlace + sizeof(std::uint32_t);

/// What the checksum of `message` should be. `message` has kChecksumEnd bytes or more, as for all
/// of these functions.
std::uint32_t compute_checksum(ByteView message);

/// What `message` says it is.
std::uint32_t claimed_checksum(ByteView message);

/// Writes the right one into `message`.
void set_checksum(Bytes& message);

}  // namespace kintsugi::codec
