// A saved map: changed, with the right checksum at its end.

#include <cstring>

#include <zlib.h>

#include "tests/decoder_fuzz/mutator.hpp"

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned /*seed*/) {
  std::uint32_t checksum = 0;
  if (max_size < sizeof(checksum)) return 0;
  const std::size_t max_body = max_size - sizeof(checksum);
  std::size_t body = size < sizeof(checksum) ? 0 : std::min(size - sizeof(checksum), max_body);
  body = LLVMFuzzerMutate(data, body, max_body);
  checksum = static_cast<std::uint32_t>(crc32_z(0, data, body));
  std::memcpy(data + body, &checksum, sizeof(checksum));
  return body + sizeof(checksum);
}
