#include "mapper/core/tsdf_block_pool.hpp"

#include <cassert>

namespace kintsugi::mapper {

TsdfBlockPool::TsdfBlockPool()
    : voxels_(kMaxBlocks * sizeof(VoxelBlock)), colors_(kMaxBlocks * sizeof(ColorBlock)) {}

BlockSlot TsdfBlockPool::take(const BlockCoord& coord) {
  if (free_.empty()) {
    const BlockSlot slot = end();
    voxels_.commit((static_cast<std::size_t>(slot) + 1) * sizeof(VoxelBlock));
    colors_.commit((static_cast<std::size_t>(slot) + 1) * sizeof(ColorBlock));
    coords_.push_back(coord);
    in_use_.push_back(0);
    free_.push_back(slot);
  }
  const BlockSlot slot = free_.back();
  free_.pop_back();
  coords_[slot] = coord;
  in_use_[slot] = 1;
  voxels(slot).voxels.fill(0);
  colors(slot).colors.fill(0);
  return slot;
}

void TsdfBlockPool::give_back(BlockSlot slot) {
  assert(in_use_[slot]);
  in_use_[slot] = 0;
  free_.push_back(slot);
}

void TsdfBlockPool::clear() {
  voxels_.release();
  colors_.release();
  coords_.clear();
  in_use_.clear();
  free_.clear();
}

std::size_t TsdfBlockPool::memory_bytes() const {
  return voxels_.committed_bytes() + colors_.committed_bytes() +
         coords_.capacity() * sizeof(BlockCoord) + in_use_.capacity() +
         free_.capacity() * sizeof(BlockSlot);
}

}  // namespace kintsugi::mapper
