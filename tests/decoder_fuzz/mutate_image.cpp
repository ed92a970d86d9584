// An image: changed; the chunks of a PNG with the right checksums.

#include <zlib.h>

#include "tests/decoder_fuzz/mutator.hpp"

namespace {

std::uint32_t read_word(const std::uint8_t* data) {
  return std::uint32_t{data[0]} << 24U | std::uint32_t{data[1]} << 16U |
         std::uint32_t{data[2]} << 8U | data[3];
}

void write_word(std::uint32_t value, std::uint8_t* data) {
  for (int i = 3; i >= 0; --i, value >>= 8U) data[i] = static_cast<std::uint8_t>(value);
}

/// A chunk: bytes of its data, type, data, CRC-32 of type and data.
void set_png_checksums(std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kAround = 12;
  for (std::size_t place = kSignature; place + kAround <= size;) {
    const std::size_t length = read_word(data + place);
    if (length > size - place - kAround) return;
    const uLong checksum = crc32_z(0, data + place + 4, length + 4);
    write_word(static_cast<std::uint32_t>(checksum), data + place + 8 + length);
    place += length + kAround;
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned /*seed*/) {
  size = LLVMFuzzerMutate(data, size, max_size);
  constexpr std::uint8_t kFirstOfPng = 0x89;
  if (size > 0 && data[0] == kFirstOfPng) set_png_checksums(data, size);
  return size;
}
