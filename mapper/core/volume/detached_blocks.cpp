#include "mapper/core/volume/detached_blocks.hpp"

#include <algorithm>

namespace kintsugi::mapper {
namespace {

const VoxelBlock* find_in(const std::vector<BlockCoord>& coords,
                          const std::vector<const VoxelBlock*>& voxels, const BlockCoord& coord) {
  const auto found = std::lower_bound(coords.begin(), coords.end(), coord);
  if (found == coords.end() || *found != coord) return nullptr;
  return voxels[found - coords.begin()];
}

}  // namespace

const VoxelBlock* DetachedBlocks::find(const BlockCoord& coord) const {
  const VoxelBlock* own = find_in(coords, voxels, coord);
  return own != nullptr ? own : find_in(apron_coords, apron_voxels, coord);
}

}  // namespace kintsugi::mapper
