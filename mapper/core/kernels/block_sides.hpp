#pragma once
// Finds the voxels of a block that were observed, and those that are behind the surface.

#include <cstdint>

#include "mapper/core/kernels/block_layout.hpp"

namespace kintsugi::mapper {

/// A bit for each voxel of rows of eight along x; bit x is voxel x.
struct RowSides {
  std::uint8_t observed = 0;  ///< more often than the threshold
  std::uint8_t behind = 0;    ///< their distance is below zero
};

/// For rows of voxels (tsdf_block.hpp) one after the other; `num_rows` is even.
using FindBlockSides = void (*)(const std::uint32_t* voxels, int num_rows, int weight_threshold,
                                RowSides* sides);

}  // namespace kintsugi::mapper
