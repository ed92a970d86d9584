#pragma once
// Volumes that hold a given distance exactly, without frames.

#include <algorithm>
#include <cmath>

#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper::testing {

/// Centre of a voxel of a block, metres.
inline Eigen::Vector3d voxel_center_W(const TsdfVolume& volume, const BlockCoord& coord,
                                      const Eigen::Vector3d& voxel) {
  const Eigen::Vector3d first = Eigen::Vector3d(coord.x, coord.y, coord.z) * kBlockSide;
  return (first + voxel + Eigen::Vector3d::Constant(0.5)) * volume.config().resolution_m;
}

/// Position of a voxel in its block, from its place in the block's array.
inline Eigen::Vector3d voxel_of_index(int index) {
  return Eigen::Vector3i(index % 8, index / 8 % 8, index / 64).cast<double>();
}

/// Allocates every block of the cube whose middle is within 12 voxels of the surface: all that
/// come within 5 voxels of it.
template <typename Function>
void allocate_around_surface(TsdfVolume& volume, Function signed_distance_m) {
  const BlockCoord& min = volume.min_block();
  const int side = volume.side_blocks();
  for (int block = 0; block < side * side * side; ++block) {
    const BlockCoord coord = make_block_coord(min.x + block % side, min.y + block / side % side,
                                              min.z + block / side / side);
    const Eigen::Vector3d middle_W = voxel_center_W(volume, coord, Eigen::Vector3d::Constant(4.0));
    if (std::abs(signed_distance_m(middle_W)) > 12 * volume.config().resolution_m) continue;
    if (volume.contains(coord)) volume.allocate(coord);
  }
}

/// Writes the distance (metres) into every voxel there is.
template <typename Function>
void set_exact_distances(TsdfVolume& volume, int weight, Function signed_distance_m) {
  for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) {
    if (!volume.in_use(slot)) continue;
    for (int i = 0; i < kBlockVoxels; ++i) {
      const Eigen::Vector3d p_W = voxel_center_W(volume, volume.coord(slot), voxel_of_index(i));
      const double fraction =
          std::clamp(signed_distance_m(p_W) / volume.max_truncation_m(), -1.0, 1.0);
      const auto raw = static_cast<std::int16_t>(std::lround(fraction * kDistanceScale));
      volume.voxels(slot).voxels[i] =
          static_cast<Voxel>(weight) << 16 | static_cast<std::uint16_t>(raw);
    }
  }
}

/// A cube around the origin with the distance in every block near to the surface.
template <typename Function>
TsdfVolume exact_volume(double size_m, double resolution_m, int weight,
                        Function signed_distance_m) {
  TsdfVolume volume(
      {.region = RegionShape::kCube, .volume_size_m = size_m, .resolution_m = resolution_m});
  allocate_around_surface(volume, signed_distance_m);
  set_exact_distances(volume, weight, signed_distance_m);
  return volume;
}

}  // namespace kintsugi::mapper::testing
