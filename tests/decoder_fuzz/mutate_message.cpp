// One message: changed, with the right checksum.

#include "lcmtypes/codec/checksum.hpp"
#include "tests/decoder_fuzz/mutator.hpp"

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned /*seed*/) {
  kintsugi::Bytes message = kintsugi::fuzzing::mutated({data, data + size}, max_size);
  if (message.size() >= kintsugi::codec::kChecksumEnd) kintsugi::codec::set_checksum(message);
  std::copy(message.begin(), message.end(), data);
  return message.size();
}
