// How blocks come back into a TsdfVolume.

#include <set>

#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

void TsdfVolume::restore(std::span<const StoredBlock> blocks, std::span<const StoredBlock> around) {
  const auto copy = [this](const StoredBlock& block, BlockSlot slot) {
    pool_.voxels(slot) = block.voxels;
    pool_.colors(slot) = block.colors;
  };
  for (const StoredBlock& block : blocks) copy(block, allocate(block.coord));
  std::set<BlockCoord> departed;
  for (const BlockSlot slot : departed_) departed.insert(coord(slot));
  for (const StoredBlock& block : around) {
    if (find(block.coord) != kNoBlock || !departed.insert(block.coord).second) continue;
    departed_.push_back(pool_.take(block.coord));
    copy(block, departed_.back());
  }
}

}  // namespace kintsugi::mapper
