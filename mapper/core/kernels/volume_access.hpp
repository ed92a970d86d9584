#pragma once

#include <cstdint>

namespace kintsugi::mapper {

/// Pointers into a TsdfVolume, for kernels that gather voxels by index. Made by
/// TsdfVolume::kernel_access(); valid until the volume changes.
///
/// Kernels use "cube coordinates", from the cube's lower corner, so that single precision is enough
/// wherever the cube is in W. In voxels, voxel (i, j, k) has its centre at (i, j, k) + 0.5; one
/// block is eight voxels.
struct VolumeAccess {
  static constexpr int kSideBits = 10;  ///< the cube has fewer than 2^kSideBits blocks a side

  /// The toroidal table: block (x, y, z), counted from W's origin, is at entry
  /// x + table_side (y + table_side z), each coordinate modulo table_side. An entry is the number
  /// of the block's slot; negative where there is no block.
  const std::int32_t* slots = nullptr;
  const std::uint32_t* voxels = nullptr;  ///< slot s begins at word 512 s; see tsdf_block.hpp
  int table_side = 0;                     ///< blocks; a power of two
  int side_blocks = 0;                    ///< of the cube
  int min_block[3] = {};                  ///< the cube's lowest block, counted from W's origin
  float truncation_vox = 0.0F;
};

}  // namespace kintsugi::mapper
