// How a TsdfVolume hands out the blocks that leave it.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "mapper/core/volume/blocks_around.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {
namespace {

/// The data of a block that stay as they are while its slice is extracted.
struct KeptBlock {
  const VoxelBlock* voxels = nullptr;
  const ColorBlock* colors = nullptr;
};

}  // namespace

DetachedBlocks TsdfVolume::snapshot() { return copy(slots_outside({}), SliceKind::kFinal); }

DetachedBlocks TsdfVolume::snapshot(std::vector<BlockSlot> slots) {
  sort_by_coord(slots);
  return copy(slots, SliceKind::kPatch);
}

DetachedBlocks TsdfVolume::copy(const std::vector<BlockSlot>& slots, SliceKind kind) {
  std::vector<BlockSlot> lent;
  DetachedBlocks blocks = describe(slots, kind, [&](BlockSlot slot, bool stays) -> KeptBlock {
    const BlockSlot copy = copies_.take_unset(coord(slot));
    copies_.voxels(copy) = voxels(slot);
    if (!stays) copies_.colors(copy) = colors(slot);
    lent.push_back(copy);
    return {&copies_.voxels(copy), &copies_.colors(copy)};
  });
  blocks.storage = copies_.lend(std::move(lent));
  return blocks;
}

DetachedBlocks TsdfVolume::detach_all(SliceKind kind) {
  BlockRegion nothing = region_;
  nothing.side = 0;
  return detach(slots_outside(nothing), kind, nothing);
}

DetachedBlocks TsdfVolume::detach(std::vector<BlockSlot> slots, SliceKind kind) {
  sort_by_coord(slots);
  return detach(slots, kind, region_);
}

void TsdfVolume::sort_by_coord(std::vector<BlockSlot>& slots) const {
  std::sort(slots.begin(), slots.end(),
            [this](BlockSlot a, BlockSlot b) { return coord(a) < coord(b); });
}

std::vector<BlockSlot> TsdfVolume::slots_around(const std::vector<BlockSlot>& leaving) const {
  enum class Part : std::uint8_t { kOther, kLeaving, kAround };
  std::vector<Part> parts(in_use_.size(), Part::kOther);
  for (const BlockSlot slot : leaving) parts[slot] = Part::kLeaving;
  std::vector<BlockSlot> slots;
  const bool none_stays = leaving.size() == num_blocks_;
  for (const BlockSlot slot : leaving) {
    if (none_stays) break;
    for_each_around(coord(slot), [&](const BlockCoord& near) {
      const BlockSlot neighbor = find(near);
      if (neighbor == kNoBlock || parts[neighbor] != Part::kOther) return;
      parts[neighbor] = Part::kAround;
      slots.push_back(neighbor);
    });
  }
  for (const BlockSlot slot : departed_) {
    if (find(coord(slot)) != kNoBlock) continue;  // there is a new block
    bool touches_leaving = false;
    for_each_around(coord(slot), [&](const BlockCoord& near) {
      const BlockSlot neighbor = find(near);
      touches_leaving |= neighbor != kNoBlock && parts[neighbor] == Part::kLeaving;
    });
    if (touches_leaving) slots.push_back(slot);
  }
  sort_by_coord(slots);
  return slots;
}

template <typename Keep>
DetachedBlocks TsdfVolume::describe(const std::vector<BlockSlot>& leaving, SliceKind kind,
                                    Keep keep) const {
  DetachedBlocks blocks;
  blocks.kind = kind;
  blocks.resolution_m = resolution_m();
  blocks.truncation_m = max_truncation_m();
  for (const BlockSlot slot : leaving) {
    blocks.coords.push_back(coord(slot));
    const KeptBlock kept = keep(slot, false);
    blocks.voxels.push_back(kept.voxels);
    blocks.colors.push_back(kept.colors);
  }
  for (const BlockSlot slot : slots_around(leaving)) {
    const bool stays = in_use(slot);
    blocks.apron_coords.push_back(coord(slot));
    const KeptBlock kept = keep(slot, stays);
    blocks.apron_voxels.push_back(kept.voxels);
    blocks.apron_colors.push_back(stays ? nullptr : kept.colors);
  }
  return blocks;
}

DetachedBlocks TsdfVolume::detach(const std::vector<BlockSlot>& leaving, SliceKind kind,
                                  const BlockRegion& region_after) {
  forget_departed_if([this](BlockSlot slot) { return find(coord(slot)) != kNoBlock; });
  std::vector<BlockSlot> lent;
  DetachedBlocks blocks = describe(leaving, kind, [&](BlockSlot slot, bool stays) -> KeptBlock {
    if (stays) {  // and will change
      lent.push_back(pool_.take_copy_of_voxels(slot));
    } else {
      pool_.hold(slot);
      lent.push_back(slot);
    }
    return {&pool_.voxels(lent.back()), &pool_.colors(lent.back())};
  });
  blocks.storage = pool_.lend(std::move(lent));
  remove(leaving);
  departed_.insert(departed_.end(), leaving.begin(), leaving.end());
  region_.min = region_after.min;
  forget_departed_if([&](BlockSlot slot) { return !borders_on(region_after, coord(slot)); });
  for (const BlockSlot slot : departed_) blocks.bordering_coords.push_back(coord(slot));
  std::sort(blocks.bordering_coords.begin(), blocks.bordering_coords.end());
  return blocks;
}

/// The pool's references to the blocks pass to departed_.
void TsdfVolume::remove(const std::vector<BlockSlot>& slots) {
  for (const BlockSlot slot : slots) {
    table_.clear(coord(slot));
    in_use_[slot] = 0;
  }
  num_blocks_ -= slots.size();
}

void TsdfVolume::discard(BlockSlot slot) {
  remove({slot});
  pool_.give_back(slot);
}

template <typename Predicate>
void TsdfVolume::forget_departed_if(Predicate predicate) {
  std::erase_if(departed_, [&](BlockSlot slot) {
    if (!predicate(slot)) return false;
    pool_.give_back(slot);
    return true;
  });
}

bool TsdfVolume::borders_on(const BlockRegion& region, const BlockCoord& coord) const {
  if (!region.contains(coord)) return region.touches(coord);
  // The cube starts empty where it comes back. In the ball a block that left because it was out of
  // view, or whose place came back, is needed while there are blocks around it.
  if (region.shape == RegionShape::kCube) return false;
  bool has_neighbors = false;
  for_each_around(coord, [&](const BlockCoord& near) { has_neighbors |= find(near) != kNoBlock; });
  return has_neighbors;
}

}  // namespace kintsugi::mapper
