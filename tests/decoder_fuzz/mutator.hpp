#pragma once
// What mutators share. A decoder rejects input with a wrong checksum at once, so each mutation is
// followed by writing the right checksum.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "lcmtypes/codec/codec.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace kintsugi::fuzzing {

/// `bytes` as changed by libFuzzer, at most `max_size` long.
inline Bytes mutated(Bytes bytes, std::size_t max_size) {
  const std::size_t size = std::min(bytes.size(), max_size);
  bytes.resize(max_size);
  bytes.resize(LLVMFuzzerMutate(bytes.data(), size, max_size));
  return bytes;
}

}  // namespace kintsugi::fuzzing
