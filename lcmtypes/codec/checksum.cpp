#include "lcmtypes/codec/checksum.hpp"

#include <array>
#include <cassert>

#include <zlib.h>

namespace kintsugi::codec {

std::uint32_t compute_checksum(ByteView message) {
  assert(message.size() >= kChecksumEnd);
  constexpr std::array<std::uint8_t, kChecksumEnd - kChecksumPlace> kNone{};
  uLong crc = crc32_z(0, message.data(), kChecksumPlace);
  crc = crc32_z(crc, kNone.data(), kNone.size());
  const ByteView rest = message.subspan(kChecksumEnd);
  // zlib starts a new checksum when it is given a null pointer, which an empty span may have.
  if (!rest.empty()) crc = crc32_z(crc, rest.data(), rest.size());
  return static_cast<std::uint32_t>(crc);
}

std::uint32_t claimed_checksum(ByteView message) {
  assert(message.size() >= kChecksumEnd);
  std::uint32_t checksum = 0;
  for (std::size_t i = kChecksumPlace; i < kChecksumEnd; ++i)
    checksum = checksum << 8U | message[i];
  return checksum;
}

void set_checksum(Bytes& message) {
  std::uint32_t checksum = compute_checksum(message);
  for (std::size_t i = kChecksumEnd; i-- > kChecksumPlace; checksum >>= 8U) {
    message[i] = static_cast<std::uint8_t>(checksum);
  }
}

}  // namespace kintsugi::codec
