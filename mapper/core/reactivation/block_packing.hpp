#pragma once

#include <cstddef>
#include <vector>

#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

/// A block in fewer bytes; unpack() gives the same block back, bit by bit.
struct PackedBlock {
  BlockCoord coord;
  std::vector<char> bytes;
};

PackedBlock pack(const BlockCoord& coord, const VoxelBlock& voxels, const ColorBlock& colors);

/// @throws std::logic_error when `packed` is not what pack() made
void unpack(const PackedBlock& packed, VoxelBlock& voxels, ColorBlock& colors);

}  // namespace kintsugi::mapper
