#pragma once
// What mutators share. A message, log, map or image with a wrong checksum gets no further than the
// comparison: so each mutation is followed by the right one.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "lcmtypes/codec/codec.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace kintsugi::fuzzing {

/// `bytes` changed in a way that libFuzzer chooses, at most `max_size` of them.
inline Bytes mutated(Bytes bytes, std::size_t max_size) {
  const std::size_t size = std::min(bytes.size(), max_size);
  bytes.resize(max_size);
  bytes.resize(LLVMFuzzerMutate(bytes.data(), size, max_size));
  return bytes;
}

}  // namespace kintsugi::fuzzing
