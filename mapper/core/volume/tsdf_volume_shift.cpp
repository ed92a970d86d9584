// How the region of a TsdfVolume moves, and what it hands out.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <tuple>
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

bool is_beyond(double offset_vox, const TsdfVolume::Config& config) {
  return std::abs(offset_vox) > config.shift_vox;
}

int whole_blocks(double offset_vox) {
  return static_cast<int>(std::lround(offset_vox / kBlockSide));
}

/// The block and the 26 around it.
template <typename Visit>
void for_each_around(const BlockCoord& coord, Visit visit) {
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        visit(make_block_coord(coord.x + dx, coord.y + dy, coord.z + dz));
      }
    }
  }
}

}  // namespace

std::vector<DetachedBlocks> TsdfVolume::shift_to(const Eigen::Vector3d& camera_W) {
  check_position(camera_W);
  ++num_moves_;
  const Eigen::Vector3d offset_vox = (camera_W - center_W()) / config_.resolution_m;
  return region_.shape == RegionShape::kCube ? shift_cube(offset_vox) : shift_ball(offset_vox);
}

std::vector<DetachedBlocks> TsdfVolume::shift_cube(const Eigen::Vector3d& offset_vox) {
  std::vector<DetachedBlocks> slices;
  for (int axis = 0; axis < 3; ++axis) {
    if (!is_beyond(offset_vox[axis], config_)) continue;
    BlockRegion moved = region_;
    axis_of(moved.min, axis) += whole_blocks(offset_vox[axis]);
    DetachedBlocks slice =
        detach(slots_outside(moved), shift_kind(axis, offset_vox[axis] > 0), moved);
    if (!slice.coords.empty()) slices.push_back(std::move(slice));
  }
  return slices;
}

std::vector<DetachedBlocks> TsdfVolume::shift_ball(const Eigen::Vector3d& offset_vox) {
  BlockRegion moved = region_;
  for (int axis = 0; axis < 3; ++axis) {
    if (is_beyond(offset_vox[axis], config_)) {
      axis_of(moved.min, axis) += whole_blocks(offset_vox[axis]);
    }
  }
  if (moved.min == region_.min && num_blocks_ <= max_blocks()) return {};
  std::vector<BlockSlot> leaving = slots_outside(moved);
  const std::size_t num_staying = num_blocks_ - leaving.size();
  if (num_staying > max_blocks()) {
    // A sixteenth at a time: slices are not too small, and need little memory while they wait.
    const std::vector<BlockSlot> surplus = longest_out_of_view(moved, max_blocks() / 16);
    leaving.insert(leaving.end(), surplus.begin(), surplus.end());
    sort_by_coord(leaving);
  }
  if (leaving.empty() && moved.min == region_.min) return {};
  const SliceKind kind = kind_of(leaving, moved);
  DetachedBlocks slice = detach(leaving, kind, moved);
  std::vector<DetachedBlocks> slices;
  if (!slice.coords.empty()) slices.push_back(std::move(slice));
  return slices;
}

SliceKind TsdfVolume::kind_of(const std::vector<BlockSlot>& leaving,
                              const BlockRegion& region) const {
  std::array<std::int64_t, 3> to_middle{};  // summed over the blocks
  for (const BlockSlot slot : leaving) {
    BlockCoord from = coord(slot);
    BlockCoord min = region.min;
    for (int axis = 0; axis < 3; ++axis) {
      to_middle[axis] += axis_of(min, axis) + region.side / 2 - axis_of(from, axis);
    }
  }
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(to_middle[axis]) > std::abs(to_middle[longest])) longest = axis;
  }
  return shift_kind(longest, to_middle[longest] > 0);
}

DetachedBlocks TsdfVolume::snapshot() const {
  auto copies = std::make_shared<TsdfBlockPool>();
  DetachedBlocks blocks = describe(slots_outside({}), SliceKind::kFinal,
                                   [&](BlockSlot slot, bool /*stays*/) -> KeptBlock {
                                     const BlockSlot copy = copies->take(coord(slot));
                                     copies->voxels(copy) = voxels(slot);
                                     copies->colors(copy) = colors(slot);
                                     return {&copies->voxels(copy), &copies->colors(copy)};
                                   });
  blocks.storage = std::move(copies);
  return blocks;
}

DetachedBlocks TsdfVolume::detach_all() {
  BlockRegion nothing = region_;
  nothing.side = 0;
  return detach(slots_outside(nothing), SliceKind::kFinal, nothing);
}

void TsdfVolume::sort_by_coord(std::vector<BlockSlot>& slots) const {
  std::sort(slots.begin(), slots.end(),
            [this](BlockSlot a, BlockSlot b) { return coord(a) < coord(b); });
}

std::vector<BlockSlot> TsdfVolume::slots_outside(const BlockRegion& region) const {
  std::vector<BlockSlot> slots;
  for (BlockSlot slot = 0; slot < slots_end(); ++slot) {
    if (in_use(slot) && !region.contains(coord(slot))) slots.push_back(slot);
  }
  sort_by_coord(slots);
  return slots;
}

std::vector<BlockSlot> TsdfVolume::longest_out_of_view(const BlockRegion& region,
                                                       std::size_t count) const {
  std::vector<BlockSlot> slots;
  for (BlockSlot slot = 0; slot < slots_end(); ++slot) {
    const bool is_out_of_view = last_seen_[slot] + 1 < num_moves_;
    if (in_use(slot) && is_out_of_view && region.contains(coord(slot))) slots.push_back(slot);
  }
  if (slots.size() <= count) return slots;
  const auto end = slots.begin() + static_cast<std::ptrdiff_t>(count);
  std::nth_element(slots.begin(), end, slots.end(), [this](BlockSlot a, BlockSlot b) {
    return std::tie(last_seen_[a], coord(a)) < std::tie(last_seen_[b], coord(b));
  });
  slots.erase(end, slots.end());
  return slots;
}

std::vector<BlockSlot> TsdfVolume::slots_around(const std::vector<BlockSlot>& leaving) const {
  enum class Part : std::uint8_t { kOther, kLeaving, kAround };
  std::vector<Part> parts(in_use_.size(), Part::kOther);
  for (const BlockSlot slot : leaving) parts[slot] = Part::kLeaving;
  std::vector<BlockSlot> slots;
  for (const BlockSlot slot : leaving) {
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
