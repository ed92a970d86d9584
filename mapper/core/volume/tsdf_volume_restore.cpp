// How blocks come back into a TsdfVolume.

#include <set>
#include <utility>

#include <tbb/parallel_for.h>

#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

void TsdfVolume::restore(std::span<const BlockCoord> blocks, std::span<const BlockCoord> around,
                         const WriteBlock& write) {
  std::vector<std::pair<std::size_t, BlockSlot>> to_write;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const BlockSlot before = find(blocks[i]);
    if (before != kNoBlock) discard(before);
    const BlockSlot slot = pool_.take_unset(blocks[i]);
    add(slot);
    to_write.emplace_back(i, slot);
  }
  std::set<BlockCoord> departed;
  for (const BlockSlot slot : departed_) departed.insert(coord(slot));
  for (std::size_t i = 0; i < around.size(); ++i) {
    if (find(around[i]) != kNoBlock || !departed.insert(around[i]).second) continue;
    departed_.push_back(pool_.take_unset(around[i]));
    to_write.emplace_back(blocks.size() + i, departed_.back());
  }
  tbb::parallel_for(std::size_t{0}, to_write.size(), [&](std::size_t i) {
    const auto& [number, slot] = to_write[i];
    write(number, pool_.voxels(slot), pool_.colors(slot));
  });
}

}  // namespace kintsugi::mapper
