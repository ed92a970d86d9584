#include "mapper/core/tsdf_volume.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>

#include "mapper/core/check.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kMinSideBlocks = 4;
constexpr int kMaxSideBlocks = 256;     // its table takes 64 MB
constexpr double kMaxPosition_m = 1e5;  // voxel coordinates stay well inside an int

int side_blocks_of(const TsdfVolume::Config& config) {
  const double blocks = config.volume_size_m / (config.resolution_m * kBlockSide);
  return static_cast<int>(std::ceil(blocks - 1e-6));
}

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

template <typename Function>
void for_each_neighbor(const BlockCoord& coord, Function function) {
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        function(make_block_coord(coord.x + dx, coord.y + dy, coord.z + dz));
      }
    }
  }
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
  side_blocks_ = side_blocks_of(config_);
  table_side_ = std::bit_ceil(static_cast<unsigned>(side_blocks_));
  table_.assign(static_cast<std::size_t>(table_side_) * table_side_ * table_side_, kNoBlock);
  const double block_m = config_.resolution_m * kBlockSide;
  for (int axis = 0; axis < 3; ++axis) {
    axis_of(min_block_, axis) =
        static_cast<int>(std::lround(center_W[axis] / block_m - 0.5 * side_blocks_));
  }
}

Eigen::Vector3d TsdfVolume::center_W() const {
  const Eigen::Vector3d center_blocks =
      Eigen::Vector3d(min_block_.x, min_block_.y, min_block_.z).array() + 0.5 * side_blocks_;
  return center_blocks * (config_.resolution_m * kBlockSide);
}

BlockSlot TsdfVolume::allocate(const BlockCoord& coord) {
  assert(contains(coord));
  BlockSlot& slot = table_[table_index(coord)];
  if (slot == kNoBlock) slot = pool_.take(coord);
  return slot;
}

std::vector<DetachedBlocks> TsdfVolume::shift_to(const Eigen::Vector3d& camera_W) {
  check_position(camera_W);
  std::vector<DetachedBlocks> slices;
  const Eigen::Vector3d offset_vox = (camera_W - center_W()) / config_.resolution_m;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(offset_vox[axis]) <= config_.shift_vox) continue;
    BlockCoord min_block = min_block_;
    axis_of(min_block, axis) += static_cast<int>(std::lround(offset_vox[axis] / kBlockSide));
    DetachedBlocks slice =
        copy_blocks(slots_outside(min_block), shift_kind(axis, offset_vox[axis] > 0));
    release(slice);
    min_block_ = min_block;
    remember_departed(slice);
    if (!slice.coords.empty()) slices.push_back(std::move(slice));
  }
  return slices;
}

DetachedBlocks TsdfVolume::snapshot() const {
  std::vector<BlockSlot> slots;
  for (BlockSlot slot = 0; slot < slots_end(); ++slot) {
    if (in_use(slot)) slots.push_back(slot);
  }
  return copy_blocks(std::move(slots), SliceKind::kFinal);
}

DetachedBlocks TsdfVolume::detach_all() {
  DetachedBlocks all = snapshot();
  std::fill(table_.begin(), table_.end(), kNoBlock);
  pool_.clear();
  departed_.clear();
  return all;
}

std::size_t TsdfVolume::memory_bytes() const {
  return pool_.memory_bytes() + table_.size() * sizeof(BlockSlot) +
         departed_.size() * (sizeof(VoxelBlock) + sizeof(BlockCoord));
}

std::vector<BlockSlot> TsdfVolume::slots_outside(const BlockCoord& min_block) const {
  std::vector<BlockSlot> slots;
  for (BlockSlot slot = 0; slot < slots_end(); ++slot) {
    if (in_use(slot) && !is_inside(coord(slot), min_block)) slots.push_back(slot);
  }
  return slots;
}

DetachedBlocks TsdfVolume::copy_blocks(std::vector<BlockSlot> slots, SliceKind kind) const {
  std::sort(slots.begin(), slots.end(),
            [this](BlockSlot a, BlockSlot b) { return coord(a) < coord(b); });
  DetachedBlocks blocks;
  blocks.kind = kind;
  blocks.resolution_m = resolution_m();
  blocks.truncation_m = truncation_m();
  blocks.coords.reserve(slots.size());
  blocks.voxels.reserve(slots.size());
  blocks.colors.reserve(slots.size());
  for (const BlockSlot slot : slots) {
    blocks.coords.push_back(coord(slot));
    blocks.voxels.push_back(voxels(slot));
    blocks.colors.push_back(colors(slot));
  }
  copy_apron(blocks);
  return blocks;
}

void TsdfVolume::copy_apron(DetachedBlocks& blocks) const {
  std::vector<BlockCoord> neighbors;
  for (const BlockCoord& coord : blocks.coords) {
    for_each_neighbor(coord, [&](const BlockCoord& neighbor) { neighbors.push_back(neighbor); });
  }
  std::sort(neighbors.begin(), neighbors.end());
  neighbors.erase(std::unique(neighbors.begin(), neighbors.end()), neighbors.end());
  for (const BlockCoord& neighbor : neighbors) {
    if (std::binary_search(blocks.coords.begin(), blocks.coords.end(), neighbor)) continue;
    const VoxelBlock* found = nullptr;
    if (const BlockSlot slot = find(neighbor); slot != kNoBlock) {
      found = &voxels(slot);
    } else if (const auto departed = departed_.find(neighbor); departed != departed_.end()) {
      found = &departed->second;
    } else {
      continue;
    }
    blocks.apron_coords.push_back(neighbor);
    blocks.apron_voxels.push_back(*found);
  }
}

void TsdfVolume::release(const DetachedBlocks& blocks) {
  for (const BlockCoord& coord : blocks.coords) {
    BlockSlot& slot = table_[table_index(coord)];
    pool_.give_back(slot);
    slot = kNoBlock;
  }
}

void TsdfVolume::remember_departed(const DetachedBlocks& blocks) {
  for (std::size_t i = 0; i < blocks.coords.size(); ++i) {
    departed_[blocks.coords[i]] = blocks.voxels[i];
  }
  std::erase_if(departed_, [this](const auto& entry) {
    bool touches_cube = false;
    for_each_neighbor(entry.first,
                      [&](const BlockCoord& coord) { touches_cube |= contains(coord); });
    return contains(entry.first) || !touches_cube;
  });
}

}  // namespace kintsugi::mapper
