#include "mapper/core/fusion/free_space.hpp"

#include <algorithm>

namespace kintsugi::mapper {
namespace {

constexpr std::uint32_t kPeriod = 16;  // moves
constexpr int kEnough = 8;             // observations
constexpr float kRounding_raw = 1.0F;  // of stored distances

}  // namespace

FreeSpace::FreeSpace(const TsdfVolume& volume)
    : is_kept_(volume.config().region == RegionShape::kCube),
      num_moves_(volume.num_moves()),
      least_distance_raw_(static_cast<int>(
          kDistanceScale * volume.truncation_m() / volume.max_truncation_m() - kRounding_raw)) {}

bool FreeSpace::is_due(const BlockCoord& coord) const {
  const auto sum = static_cast<std::uint32_t>(coord.x + coord.y + coord.z);
  return !is_kept_ && (sum + num_moves_) % kPeriod == 0;
}

bool FreeSpace::is_all_of(const VoxelBlock& block) const {
  int nearest_raw = voxel_distance_raw(0x7FFF);
  int most_observations = 0;
  for (const Voxel voxel : block.voxels) {  // no branches, so that the compiler can vectorise it
    const int weight = voxel_weight(voxel);
    const int distance_raw = weight > 0 ? voxel_distance_raw(voxel) : nearest_raw;
    nearest_raw = std::min(nearest_raw, distance_raw);
    most_observations = std::max(most_observations, weight);
  }
  return nearest_raw >= least_distance_raw_ && most_observations >= kEnough;
}

}  // namespace kintsugi::mapper
