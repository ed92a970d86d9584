// How the cube of a TsdfVolume moves, and what it hands out.

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {
namespace {

/// The data of a block that stay as they are while its slice is extracted.
struct KeptBlock {
  const VoxelBlock* voxels = nullptr;
  const ColorBlock* colors = nullptr;
};

int& axis_of(BlockCoord& coord, int axis) {
  return axis == 0 ? coord.x : (axis == 1 ? coord.y : coord.z);
}

SliceKind shift_kind(int axis, bool towards_plus) {
  return static_cast<SliceKind>(1 + 2 * axis + (towards_plus ? 0 : 1));
}
static_assert(static_cast<int>(SliceKind::kShiftMinusZ) == 1 + 2 * 2 + 1);

/// Whether `predicate` holds for the block or one of the 26 around it.
template <typename Predicate>
bool any_around(const BlockCoord& coord, Predicate predicate) {
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (predicate(make_block_coord(coord.x + dx, coord.y + dy, coord.z + dz))) return true;
      }
    }
  }
  return false;
}

}  // namespace

std::vector<DetachedBlocks> TsdfVolume::shift_to(const Eigen::Vector3d& camera_W) {
  check_position(camera_W);
  std::vector<DetachedBlocks> slices;
  const Eigen::Vector3d offset_vox = (camera_W - center_W()) / config_.resolution_m;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(offset_vox[axis]) <= config_.shift_vox) continue;
    BlockCube remaining = cube_;
    axis_of(remaining.min, axis) += static_cast<int>(std::lround(offset_vox[axis] / kBlockSide));
    DetachedBlocks slice = detach(shift_kind(axis, offset_vox[axis] > 0), remaining);
    cube_ = remaining;
    if (!slice.coords.empty()) slices.push_back(std::move(slice));
  }
  return slices;
}

DetachedBlocks TsdfVolume::snapshot() const {
  auto copies = std::make_shared<TsdfBlockPool>();
  DetachedBlocks blocks =
      describe(slots_outside({}), SliceKind::kFinal, {}, [&](BlockSlot slot) -> KeptBlock {
        const BlockSlot copy = copies->take(coord(slot));
        copies->voxels(copy) = voxels(slot);
        copies->colors(copy) = colors(slot);
        return {&copies->voxels(copy), &copies->colors(copy)};
      });
  blocks.storage = std::move(copies);
  return blocks;
}

DetachedBlocks TsdfVolume::detach_all() { return detach(SliceKind::kFinal, {}); }

void TsdfVolume::sort_by_coord(std::vector<BlockSlot>& slots) const {
  std::sort(slots.begin(), slots.end(),
            [this](BlockSlot a, BlockSlot b) { return coord(a) < coord(b); });
}

std::vector<BlockSlot> TsdfVolume::slots_outside(const BlockCube& remaining) const {
  std::vector<BlockSlot> slots;
  for (BlockSlot slot = 0; slot < slots_end(); ++slot) {
    if (in_use(slot) && !remaining.contains(coord(slot))) slots.push_back(slot);
  }
  sort_by_coord(slots);
  return slots;
}

std::vector<BlockSlot> TsdfVolume::slots_around_outside(const BlockCube& remaining) const {
  const BlockCube inner{
      make_block_coord(remaining.min.x + 1, remaining.min.y + 1, remaining.min.z + 1),
      std::max(remaining.side - 2, 0)};
  const auto touches_leaving = [&](const BlockCoord& near) {
    return any_around(near, [&](const BlockCoord& other) {
      return !remaining.contains(other) && find(other) != kNoBlock;
    });
  };
  std::vector<BlockSlot> slots;
  for (BlockSlot slot = 0; slot < slots_end(); ++slot) {
    if (!in_use(slot) || !remaining.contains(coord(slot)) || inner.contains(coord(slot))) continue;
    if (touches_leaving(coord(slot))) slots.push_back(slot);
  }
  for (const BlockSlot slot : departed_) {
    if (touches_leaving(coord(slot))) slots.push_back(slot);
  }
  sort_by_coord(slots);
  return slots;
}

template <typename Keep>
DetachedBlocks TsdfVolume::describe(const std::vector<BlockSlot>& slots, SliceKind kind,
                                    const BlockCube& remaining, Keep keep) const {
  DetachedBlocks blocks;
  blocks.kind = kind;
  blocks.resolution_m = resolution_m();
  blocks.truncation_m = truncation_m();
  blocks.remaining = remaining;
  for (const BlockSlot slot : slots) {
    blocks.coords.push_back(coord(slot));
    const KeptBlock kept = keep(slot);
    blocks.voxels.push_back(kept.voxels);
    blocks.colors.push_back(kept.colors);
  }
  for (const BlockSlot slot : slots_around_outside(remaining)) {
    const bool stays = in_use(slot);
    blocks.apron_coords.push_back(coord(slot));
    const KeptBlock kept = keep(slot);
    blocks.apron_voxels.push_back(kept.voxels);
    blocks.apron_colors.push_back(stays ? nullptr : kept.colors);
  }
  return blocks;
}

DetachedBlocks TsdfVolume::detach(SliceKind kind, const BlockCube& remaining) {
  const std::vector<BlockSlot> leaving = slots_outside(remaining);
  std::vector<BlockSlot> lent;
  DetachedBlocks blocks = describe(leaving, kind, remaining, [&](BlockSlot slot) -> KeptBlock {
    if (in_use(slot) && remaining.contains(coord(slot))) {  // stays and will change
      lent.push_back(pool_.take_copy_of_voxels(slot));
    } else {
      pool_.hold(slot);
      lent.push_back(slot);
    }
    return {&pool_.voxels(lent.back()), &pool_.colors(lent.back())};
  });
  blocks.storage = pool_.lend(std::move(lent));
  update_departed(leaving, remaining);
  remove(leaving);
  return blocks;
}

void TsdfVolume::remove(const std::vector<BlockSlot>& slots) {
  for (const BlockSlot slot : slots) {
    table_[table_index(coord(slot))] = kNoBlock;
    in_use_[slot] = 0;
    pool_.give_back(slot);
  }
  num_blocks_ -= slots.size();
}

void TsdfVolume::update_departed(const std::vector<BlockSlot>& leaving,
                                 const BlockCube& remaining) {
  const auto borders = [&](BlockSlot slot) {
    return remaining.touches(coord(slot)) && !remaining.contains(coord(slot));
  };
  std::erase_if(departed_, [&](BlockSlot slot) {
    if (borders(slot)) return false;
    pool_.give_back(slot);
    return true;
  });
  for (const BlockSlot slot : leaving) {
    if (!borders(slot)) continue;
    pool_.hold(slot);
    departed_.push_back(slot);
  }
}

}  // namespace kintsugi::mapper
