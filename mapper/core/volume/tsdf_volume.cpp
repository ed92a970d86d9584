#include "mapper/core/volume/tsdf_volume.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kMinSideBlocks = 4;
constexpr int kMaxSideBlocks = 256;     // its table takes 64 MB
constexpr double kMaxPosition_m = 1e5;  // voxel coordinates stay well inside an int

int side_blocks_of(const TsdfVolume::Config& config) {
  const double blocks = config.volume_size_m / (config.resolution_m * kBlockSide);
  return static_cast<int>(std::ceil(blocks - 1e-6));
}

/// A block's data where nobody changes them while its slice is extracted.
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

void check_position(const Eigen::Vector3d& position_W) {
  for (int axis = 0; axis < 3; ++axis) {
    check_range("position of the volume, metres", position_W[axis], -kMaxPosition_m,
                kMaxPosition_m);
  }
}

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

void TsdfVolume::Config::validate() const {
  check_range("volume_size_m", volume_size_m, 0.01, 100.0);
  check_range("resolution_m", resolution_m, 0.0005, 1.0);
  check_range("truncation_vox", truncation_vox, 2.0, 16.0);
  check_range("max_weight", max_weight, 1, 65535);
  check_range("volume_size_m / (8 resolution_m), the cube's side in blocks", side_blocks_of(*this),
              kMinSideBlocks, kMaxSideBlocks);
  // At least a block, or the cube would never move; at most to where the camera leaves the cube.
  check_range("shift_vox", shift_vox, kBlockSide, side_blocks_of(*this) * kBlockSide / 2 - 1);
}

TsdfVolume::TsdfVolume(const Config& config, const Eigen::Vector3d& center_W) : config_(config) {
  config_.validate();
  check_position(center_W);
  cube_.side = side_blocks_of(config_);
  table_side_ = std::bit_ceil(static_cast<unsigned>(cube_.side));
  table_.assign(static_cast<std::size_t>(table_side_) * table_side_ * table_side_, kNoBlock);
  const double block_m = config_.resolution_m * kBlockSide;
  for (int axis = 0; axis < 3; ++axis) {
    axis_of(cube_.min, axis) =
        static_cast<int>(std::lround(center_W[axis] / block_m - 0.5 * cube_.side));
  }
}

Eigen::Vector3d TsdfVolume::center_W() const {
  const Eigen::Vector3d center_blocks =
      Eigen::Vector3d(cube_.min.x, cube_.min.y, cube_.min.z).array() + 0.5 * cube_.side;
  return center_blocks * (config_.resolution_m * kBlockSide);
}

BlockSlot TsdfVolume::allocate(const BlockCoord& coord) {
  assert(contains(coord));
  BlockSlot& slot = table_[table_index(coord)];
  if (slot != kNoBlock) return slot;
  slot = pool_.take(coord);
  in_use_.resize(pool_.end(), 0);
  in_use_[slot] = 1;
  ++num_blocks_;
  return slot;
}

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

std::size_t TsdfVolume::memory_bytes() const {
  return pool_.memory_bytes() + table_.capacity() * sizeof(BlockSlot) + in_use_.capacity() +
         departed_.capacity() * sizeof(BlockSlot);
}

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
    if (in_use(slot) && remaining.contains(coord(slot))) {  // goes on changing
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
