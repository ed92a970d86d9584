#include "mapper/core/volume/tsdf_volume.hpp"

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
constexpr int kMaxSideBlocks = 256;  // the table of blocks reserves 64 MB
constexpr int kMaxRadiusBlocks = (kMaxSideBlocks - 1) / 2;
constexpr double kShortestRange_m = 0.01;
constexpr double kLongestRange_m = 100.0;
constexpr double kMaxPosition_m = 1e5;  // voxel coordinates stay well inside an int

int blocks_along(double length_m, const TsdfVolume::Config& config) {
  return static_cast<int>(std::ceil(length_m / (config.resolution_m * kBlockSide) - 1e-6));
}

/// To the farthest block's centre: the camera is up to shift_vox from the middle along each axis,
/// and a point up to half a diagonal from the centre of its block.
double ball_radius_m(const TsdfVolume::Config& config) {
  const double slack_vox = std::sqrt(3.0) * (config.shift_vox + 0.5 * kBlockSide);
  return config.max_range_m + (config.truncation_vox + slack_vox) * config.resolution_m;
}

/// With which the ball still has a range of kShortestRange_m.
int largest_shift_vox(const TsdfVolume::Config& config) {
  const double range_vox = kShortestRange_m / config.resolution_m;
  const double slack_vox = kMaxRadiusBlocks * kBlockSide - range_vox - config.truncation_vox;
  return static_cast<int>(slack_vox / std::sqrt(3.0) - 0.5 * kBlockSide);
}

/// Of the cube around the region.
int side_blocks_of(const TsdfVolume::Config& config) {
  return config.region == RegionShape::kCube ? blocks_along(config.volume_size_m, config)
                                             : 2 * blocks_along(ball_radius_m(config), config) + 1;
}

}  // namespace

void TsdfVolume::Config::validate() const {
  check_range("resolution_m", resolution_m, 0.0005, 1.0);
  check_range("volume_size_m", volume_size_m, kShortestRange_m, kLongestRange_m);
  check_range("truncation_vox", truncation_vox, 2.0, 16.0);
  check_range("max_truncation_vox", max_truncation_vox, truncation_vox, 64.0);
  check_range("max_weight", max_weight, 1, 65535);
  check_range("max_memory_mb", max_memory_mb, 1.0, TsdfBlockPool::kMaxBlocks * kBlockBytes / 1e6);
  if (region == RegionShape::kCube) {
    check_range("volume_size_m / (8 resolution_m), the cube's side in blocks",
                side_blocks_of(*this), kMinSideBlocks, kMaxSideBlocks);
    // The cube moves by whole blocks; at the upper bound the camera is still inside it.
    check_range("shift_vox", shift_vox, kBlockSide, side_blocks_of(*this) * kBlockSide / 2 - 1);
    check_range("max_range_m", max_range_m, kShortestRange_m, kLongestRange_m);
  } else {
    check_range("shift_vox", shift_vox, kBlockSide, largest_shift_vox(*this));
    check_range("max_range_m", max_range_m, kShortestRange_m,
                std::min(kLongestRange_m, longest_range_m(*this)));
  }
}

double TsdfVolume::longest_range_m(const Config& config) {
  Config without_range = config;
  without_range.max_range_m = 0.0;
  return kMaxRadiusBlocks * kBlockSide * config.resolution_m - ball_radius_m(without_range);
}

TsdfVolume::TsdfVolume(const Config& config, const Eigen::Vector3d& center_W)
    : config_((config.validate(), config)), table_(side_blocks_of(config)) {
  region_.shape = config_.region;
  region_.side = side_blocks_of(config_);
  center_at(center_W);
}

void TsdfVolume::center_at(const Eigen::Vector3d& center_W) {
  check_position(center_W);
  assert(num_blocks_ == 0);
  const double block_m = config_.resolution_m * kBlockSide;
  const auto lowest_block = [&](double center_m) {
    return static_cast<int>(std::lround(center_m / block_m - 0.5 * region_.side));
  };
  region_.min = make_block_coord(lowest_block(center_W.x()), lowest_block(center_W.y()),
                                 lowest_block(center_W.z()));
}

Eigen::Vector3d TsdfVolume::center_W() const {
  const Eigen::Vector3d center_blocks =
      Eigen::Vector3d(region_.min.x, region_.min.y, region_.min.z).array() + 0.5 * region_.side;
  return center_blocks * (config_.resolution_m * kBlockSide);
}

BlockSlot TsdfVolume::allocate(const BlockCoord& coord) {
  assert(contains(coord));
  const BlockSlot known = table_.find(coord);
  if (known != kNoBlock) return known;
  const BlockSlot slot = pool_.take(coord);
  add(slot);
  return slot;
}

/// A new block of the pool becomes one of the volume, in view.
void TsdfVolume::add(BlockSlot slot) {
  table_.set(coord(slot), slot);
  in_use_.resize(pool_.end(), 0);
  in_use_[slot] = 1;
  last_seen_.resize(pool_.end(), 0);
  last_seen_[slot] = num_moves_;
  ++num_blocks_;
}

VolumeAccess TsdfVolume::kernel_access() const {
  assert(region_.side < 1 << VolumeAccess::kSideBits);
  return {.entries = table_.entries(),
          .voxels = pool_.voxels(0).voxels.data(),
          .table_side = table_.side(),
          .side_blocks = region_.side,
          .min_block = {region_.min.x, region_.min.y, region_.min.z},
          .truncation_vox = static_cast<float>(config_.largest_truncation_vox()),
          .max_step_vox = static_cast<float>(config_.truncation_vox)};
}

std::size_t TsdfVolume::memory_bytes() const {
  return pool_.memory_bytes() + copies_.memory_bytes() + table_.memory_bytes() +
         in_use_.capacity() + last_seen_.capacity() * sizeof(std::uint32_t) +
         departed_.capacity() * sizeof(BlockSlot);
}

void TsdfVolume::check_position(const Eigen::Vector3d& position_W) {
  for (int axis = 0; axis < 3; ++axis) {
    check_range("position of the volume, metres", position_W[axis], -kMaxPosition_m,
                kMaxPosition_m);
  }
}

}  // namespace kintsugi::mapper
