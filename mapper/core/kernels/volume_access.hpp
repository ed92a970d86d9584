#pragma once

#include <cstdint>

namespace kintsugi::mapper {

/// Pointers into a TsdfVolume, for kernels that gather voxels by index. Made by
/// TsdfVolume::kernel_access(); valid until the volume changes.
///
/// Kernels use "cube coordinates", from the lower corner of the cube around the volume's region, so
/// that single precision is enough wherever the region is in W. In voxels, voxel (i, j, k) has its
/// centre at (i, j, k) + 0.5; one block is eight voxels.
struct VolumeAccess {
  static constexpr int kSideBits = 10;  ///< the cube has fewer than 2^kSideBits blocks a side
  static constexpr int kBrickSideBits = 3;
  static constexpr int kBrickSide = 1 << kBrickSideBits;  ///< blocks

  /// The toroidal table in bricks of 8 x 8 x 8 entries, x fastest in a brick and from brick to
  /// brick, so that only memory near blocks is used: block (x, y, z), counted from W's origin, is
  /// at (x, y, z) modulo table_side. An entry is the number of the block's slot plus one; zero
  /// where there is no block.
  const std::int32_t* entries = nullptr;
  const std::uint32_t* voxels = nullptr;  ///< slot s begins at word 512 s; see tsdf_block.hpp
  int table_side = 0;                     ///< blocks; a power of two, at least kBrickSide
  int side_blocks = 0;                    ///< of the cube around the volume's region
  int min_block[3] = {};                  ///< the cube's lowest block, counted from W's origin
  float truncation_vox = 0.0F;            ///< stored distances are fractions of this
  float max_step_vox = 0.0F;              ///< of a ray: no surface's band is thinner
};

}  // namespace kintsugi::mapper
