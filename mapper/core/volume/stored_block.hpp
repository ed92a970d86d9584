#pragma once

#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

/// A block as it was when it left the volume.
struct StoredBlock {
  BlockCoord coord;
  VoxelBlock voxels;
  ColorBlock colors;
};

}  // namespace kintsugi::mapper
