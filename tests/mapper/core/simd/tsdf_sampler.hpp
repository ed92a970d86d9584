#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper::testing {

/// Reads a volume at any point, one at a time: what the vector kernels are tested against. Points
/// are in voxels from the cube's lower corner ("cube coordinates": single precision is then enough
/// wherever the cube is); voxel (i, j, k) has its centre at (i, j, k) + 0.5. Remembers the last
/// block: one sampler for each thread, and none across a change of the volume.
class TsdfSampler {
 public:
  explicit TsdfSampler(const TsdfVolume& volume) : volume_(volume) {}

  /// The voxel in which the point lies; none where there is no block.
  std::optional<Voxel> nearest(const Eigen::Vector3f& point_vox);

  /// Trilinear, as a fraction of the truncation distance; none where one of the eight voxels
  /// around the point was never observed.
  std::optional<float> distance(const Eigen::Vector3f& point_vox);

 private:
  /// The block of a voxel in cube coordinates.
  BlockSlot slot_of(int x, int y, int z);

  const TsdfVolume& volume_;
  BlockCoord last_block_{.z = -1, .y = -1, .x = -1};  ///< from the cube's lower corner
  BlockSlot last_slot_ = kNoBlock;
};

}  // namespace kintsugi::mapper::testing
