#pragma once
// The checksum of a message: the CRC-32 (as zlib computes it) of its bytes. It is stored in the
// four bytes behind LCM's fingerprint, big-endian as all LCM integers; for the computation these
// four bytes count as zero.

#include <cstddef>
#include <cstdint>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::codec {

inline constexpr std::size_t kChecksumPlace = 8;
inline constexpr std::size_t kChecksumEnd = kChecksumPlace + sizeof(std::uint32_t);

/// Computes the checksum of `message`, which must have kChecksumEnd bytes or more, as for all of
/// these functions.
std::uint32_t compute_checksum(ByteView message);

/// The checksum that is stored in `message`.
std::uint32_t claimed_checksum(ByteView message);

/// Computes the checksum and stores it in `message`.
void set_checksum(Bytes& message);

}  // namespace kintsugi::codec
