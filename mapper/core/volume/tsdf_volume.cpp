#include "mapper/core/volume/tsdf_volume.hpp"

#include <bit>
#include <cassert>
#include <cmath>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/kernels/block_layout.hpp"

namespace kintsugi::mapper {
namespace {

static_assert(BlockLayout::kSide == kBlockSide);
static_assert(1 << BlockLayout::kVoxelBits == kBlockVoxels);
static_assert(BlockLayout::kDistanceScale == kDistanceScale);

constexpr int kMinSideBlocks = 4;
constexpr int kMaxSideBlocks = 256;     // the table of blocks takes 64 MB
constexpr double kMaxPosition_m = 1e5;  // voxel coordinates stay well inside an int

int side_blocks_of(const TsdfVolume::Config& config) {
  const double blocks = config.volume_size_m / (config.resolution_m * kBlockSide);
  return static_cast<int>(std::ceil(blocks - 1e-6));
}

}  // namespace

void TsdfVolume::Config::validate() const {
  check_range("volume_size_m", volume_size_m, 0.01, 100.0);
  check_range("resolution_m", resolution_m, 0.0005, 1.0);
  check_range("truncation_vox", truncation_vox, 2.0, 16.0);
  check_range("max_weight", max_weight, 1, 65535);
  check_range("volume_size_m / (8 resolution_m), the cube's side in blocks", side_blocks_of(*this),
              kMinSideBlocks, kMaxSideBlocks);
  // The cube moves by whole blocks; at the upper bound the camera is still inside it.
  check_range("shift_vox", shift_vox, kBlockSide, side_blocks_of(*this) * kBlockSide / 2 - 1);
}

TsdfVolume::TsdfVolume(const Config& config, const Eigen::Vector3d& center_W) : config_(config) {
  config_.validate();
  check_position(center_W);
  cube_.side = side_blocks_of(config_);
  table_side_ = std::bit_ceil(static_cast<unsigned>(cube_.side));
  table_.assign(static_cast<std::size_t>(table_side_) * table_side_ * table_side_, kNoBlock);
  const double block_m = config_.resolution_m * kBlockSide;
  const auto lowest_block = [&](double center_m) {
    return static_cast<int>(std::lround(center_m / block_m - 0.5 * cube_.side));
  };
  cube_.min = make_block_coord(lowest_block(center_W.x()), lowest_block(center_W.y()),
                               lowest_block(center_W.z()));
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

VolumeAccess TsdfVolume::kernel_access() const {
  assert(cube_.side < 1 << VolumeAccess::kSideBits);
  return {.slots = table_.data(),
          .voxels = pool_.voxels(0).voxels.data(),
          .table_side = static_cast<int>(table_side_),
          .side_blocks = cube_.side,
          .min_block = {cube_.min.x, cube_.min.y, cube_.min.z},
          .truncation_vox = static_cast<float>(config_.truncation_vox)};
}

std::size_t TsdfVolume::memory_bytes() const {
  return pool_.memory_bytes() + table_.capacity() * sizeof(BlockSlot) + in_use_.capacity() +
         departed_.capacity() * sizeof(BlockSlot);
}

void TsdfVolume::check_position(const Eigen::Vector3d& position_W) {
  for (int axis = 0; axis < 3; ++axis) {
    check_range("position of the volume, metres", position_W[axis], -kMaxPosition_m,
                kMaxPosition_m);
  }
}

}  // namespace kintsugi::mapper
