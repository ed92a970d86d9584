#include "mapper/core/reactivation/block_packing.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>

#include <lz4.h>

namespace kintsugi::mapper {
namespace {

constexpr int kNumBytes = sizeof(VoxelBlock) + sizeof(ColorBlock);
using Planes = std::array<char, kNumBytes>;

// Lowest bytes of all words first, then the next ones: neighbouring voxels have similar weights,
// and distances that differ little, so LZ4 finds more that repeats.

/// Writes the words as four planes, and returns where they end.
char* split(std::span<const std::uint32_t> words, char* out) {
  for (int shift = 0; shift < 32; shift += 8) {
    for (const std::uint32_t word : words) *out++ = static_cast<char>(word >> shift & 0xFFU);
  }
  return out;
}

const char* join(const char* in, std::span<std::uint32_t> words) {
  std::ranges::fill(words, 0U);
  for (int shift = 0; shift < 32; shift += 8) {
    for (std::uint32_t& word : words) {
      word |= std::uint32_t{static_cast<std::uint8_t>(*in++)} << shift;
    }
  }
  return in;
}

}  // namespace

PackedBlock pack(const BlockCoord& coord, const VoxelBlock& voxels, const ColorBlock& colors) {
  Planes planes;
  split(colors.colors, split(voxels.voxels, planes.data()));
  std::array<char, LZ4_COMPRESSBOUND(kNumBytes)> packed;
  const int size = LZ4_compress_default(planes.data(), packed.data(), kNumBytes,
                                        static_cast<int>(packed.size()));
  return {coord, std::vector<char>(packed.begin(), packed.begin() + size)};
}

void unpack(const PackedBlock& packed, VoxelBlock& voxels, ColorBlock& colors) {
  Planes planes;
  const int size = LZ4_decompress_safe(packed.bytes.data(), planes.data(),
                                       static_cast<int>(packed.bytes.size()), kNumBytes);
  if (size != kNumBytes) throw std::logic_error("unpack: these bytes are not of a block");
  join(join(planes.data(), voxels.voxels), colors.colors);
}

}  // namespace kintsugi::mapper
