#pragma once

#include <bitset>
#include <vector>

#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

using VoxelSet = std::bitset<kBlockVoxels>;

/// Of a block, the voxels at a surface, and what another map has there. What is neither covered nor
/// differing is not known: the other map has not observed it, or cannot be told from noise.
struct CoveredVoxels {
  VoxelSet surface;
  VoxelSet covered;    ///< the same surface
  VoxelSet differing;  ///< no surface, or another one

  bool has_rest() const { return (surface & ~covered).any(); }
};

/// What is covered, without gaps and specks: where a third of the surface within two voxels is
/// covered, all is (a morphological closing) that does not differ. Of two surfaces that are the
/// same but for their noise, voxels that are decided by themselves would leave just those that
/// deviate, each alone among cleared ones, where its normal means nothing. `coords`: of the blocks,
/// each once, in any order.
std::vector<CoveredVoxels> closed(const std::vector<BlockCoord>& coords,
                                  const std::vector<CoveredVoxels>& blocks);

}  // namespace kintsugi::mapper
