#pragma once

#include <Eigen/Core>
#include <optional>

#include "tests/mapper/core/simd/tsdf_sampler.hpp"

namespace kintsugi::mapper::testing {

/// A ray in cube coordinates (see TsdfSampler), by depth along the camera's z.
struct Ray {
  Eigen::Vector3f origin_vox;
  Eigen::Vector3f direction_vox_per_m;

  Eigen::Vector3f at(float depth_m) const { return origin_vox + direction_vox_per_m * depth_m; }
};

/// Finds where a ray goes from free space into a surface.
class RayMarcher {
 public:
  RayMarcher(const TsdfVolume& volume, const Ray& ray, TsdfSampler& sampler);

  /// Depth of the first crossing from positive to negative distance between two depths; none where
  /// there is none, or where the ray is in a surface from the start.
  std::optional<float> find_surface(float from_m, float to_m);

 private:
  /// Two depths with a surface between them, and the distances there (voxels).
  struct Bracket {
    float before_m = 0.0F;
    float after_m = 0.0F;
    float distance_before = 0.0F;
    float distance_after = 0.0F;
  };
  std::optional<Bracket> march(float from_m, float to_m);
  std::optional<float> refine(const Bracket& bracket);
  float depth_of_block_exit(float depth_m) const;

  const Ray& ray_;
  TsdfSampler& sampler_;
  Eigen::Vector3f m_per_vox_;  ///< along each axis; infinite along an axis the ray does not move
  float voxel_m_ = 0.0F;       ///< depth in which the ray advances by one voxel
  float truncation_vox_ = 0.0F;
  float max_step_vox_ = 0.0F;
};

}  // namespace kintsugi::mapper::testing
