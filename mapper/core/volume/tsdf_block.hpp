#pragma once
// A block of 8 x 8 x 8 voxels: the unit in which the volume allocates, shifts and hands out.
//
// Voxel (i, j, k), any integers, has its centre at ((i, j, k) + 0.5) * resolution_m in W. Block
// (x, y, z) holds voxels 8 (x, y, z) .. 8 (x, y, z) + 7, x fastest.

#include <array>
#include <compare>
#include <cstdint>

namespace kintsugi::mapper {

inline constexpr int kBlockSide = 8;  ///< voxels
inline constexpr int kBlockVoxels = kBlockSide * kBlockSide * kBlockSide;

/// Coordinates of a block, in blocks from W's origin. Ordered by z, then y, then x.
struct BlockCoord {
  int z = 0;
  int y = 0;
  int x = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 sees a pointer in the defaulted body
  auto operator<=>(const BlockCoord&) const = default;
};

inline BlockCoord make_block_coord(int x, int y, int z) { return {.z = z, .y = y, .x = x}; }

inline constexpr int voxel_index(int x, int y, int z) {
  return (z * kBlockSide + y) * kBlockSide + x;
}

/// One voxel in one word: the low 16 bits are the signed distance along the camera's z, as a
/// fraction of the largest truncation distance times kDistanceScale, positive in free space; the
/// high 16 bits are the weight, the number of observations. Weight zero: never observed.
using Voxel = std::uint32_t;

inline constexpr float kDistanceScale = 32767.0F;

inline constexpr int voxel_weight(Voxel voxel) { return static_cast<int>(voxel >> 16); }
inline constexpr int voxel_distance_raw(Voxel voxel) {
  return static_cast<std::int16_t>(voxel & 0xFFFFU);
}
/// In [-1, 1]: 1 is the largest truncation distance.
inline constexpr float voxel_distance(Voxel voxel) {
  return static_cast<float>(voxel_distance_raw(voxel)) * (1.0F / kDistanceScale);
}

/// Mean colour of a voxel in one word, lowest byte first: red, green, blue, and the number of
/// observations it is the mean of, at most 255. Zero observations: no colour.
using VoxelColor = std::uint32_t;

struct alignas(64) VoxelBlock {
  std::array<Voxel, kBlockVoxels> voxels;
};

struct alignas(64) ColorBlock {
  std::array<VoxelColor, kBlockVoxels> colors;
};

}  // namespace kintsugi::mapper
