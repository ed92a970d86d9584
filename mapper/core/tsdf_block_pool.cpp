#include "mapper/core/tsdf_block_pool.hpp"

#include <cassert>

namespace kintsugi::mapper {

BlockSlot TsdfBlockPool::take(const BlockCoord& coord) {
  if (free_.empty()) {
    const BlockSlot slot = end();
    if (index_in_chunk(slot) == 0) chunks_.push_back(std::make_unique_for_overwrite<Chunk>());
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
  chunks_.clear();
  coords_.clear();
  in_use_.clear();
  free_.clear();
}

std::size_t TsdfBlockPool::memory_bytes() const {
  return chunks_.size() * sizeof(Chunk) + coords_.capacity() * sizeof(BlockCoord) +
         in_use_.capacity() + free_.capacity() * sizeof(BlockSlot);
}

}  // namespace kintsugi::mapper
