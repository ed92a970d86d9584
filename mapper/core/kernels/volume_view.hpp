#pragma once

#include <cstdint>

namespace kintsugi::mapper {

/// The volume as vector registers reach it: by indices from two places.
///
/// Kernels count in "cube coordinates", from the cube's lower corner, so that single precision is
/// enough wherever the cube is. In voxels, voxel (i, j, k) has its centre at (i, j, k) + 0.5; a
/// block is eight of them.
struct VolumeView {
  static constexpr int kSideBits = 10;  ///< the cube has fewer than 2^kSideBits blocks a side

  const std::int32_t* slots = nullptr;    ///< the toroidal table of blocks; negative: no block
  const std::uint32_t* voxels = nullptr;  ///< 512 words a slot; see tsdf_block.hpp
  int table_side = 0;                     ///< blocks; a power of two
  int side_blocks = 0;                    ///< of the cube
  int min_block[3] = {};                  ///< the cube's lowest block, from W's origin
  float truncation_vox = 0.0F;
};

}  // namespace kintsugi::mapper
