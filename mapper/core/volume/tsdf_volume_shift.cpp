// How the region of a TsdfVolume moves, and which blocks leave it.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {
namespace {

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

}  // namespace

std::vector<DetachedBlocks> TsdfVolume::shift_to(const Eigen::Vector3d& camera_W,
                                                 const BeforeLeaving& before_leaving) {
  check_position(camera_W);
  pool_.tidy();
  ++num_moves_;
  const Eigen::Vector3d offset_vox = (camera_W - center_W()) / config_.resolution_m;
  return region_.shape == RegionShape::kCube ? shift_cube(offset_vox)
                                             : shift_ball(offset_vox, before_leaving);
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

std::vector<DetachedBlocks> TsdfVolume::shift_ball(const Eigen::Vector3d& offset_vox,
                                                   const BeforeLeaving& before_leaving) {
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
  if (before_leaving && !leaving.empty()) {
    before_leaving(leaving);
    std::erase_if(leaving, [this](BlockSlot slot) { return !in_use(slot); });
  }
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

}  // namespace kintsugi::mapper
