#include "tests/mapper/core/simd/ray_marcher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kintsugi::mapper::testing {
namespace {

/// A ray advances by this share of the distance: it was measured along other rays.
constexpr float kStepShare = 0.8F;

}  // namespace

RayMarcher::RayMarcher(const TsdfVolume& volume, const Ray& ray, TsdfSampler& sampler)
    : ray_(ray),
      sampler_(sampler),
      m_per_vox_(ray.direction_vox_per_m.cwiseInverse()),
      voxel_m_(1.0F / ray.direction_vox_per_m.norm()),
      truncation_vox_(static_cast<float>(volume.config().largest_truncation_vox())),
      max_step_vox_(static_cast<float>(volume.config().truncation_vox)) {}

std::optional<float> RayMarcher::find_surface(float from_m, float to_m) {
  const std::optional<Bracket> bracket = march(from_m, to_m);
  return bracket ? refine(*bracket) : std::nullopt;
}

std::optional<RayMarcher::Bracket> RayMarcher::march(float from_m, float to_m) {
  Bracket bracket;
  bool in_free_space = false;
  float max_step_vox = max_step_vox_;
  float depth_m = from_m;
  while (depth_m < to_m) {
    const std::optional<Voxel> voxel = sampler_.nearest(ray_.at(depth_m));
    if (voxel && voxel_weight(*voxel) > 0) {
      const float distance = voxel_distance(*voxel) * truncation_vox_;
      if (distance <= 0.0F) {
        if (!in_free_space) return std::nullopt;
        bracket.after_m = depth_m;
        bracket.distance_after = distance;
        return bracket;
      }
      in_free_space = true;
      bracket.before_m = depth_m;
      bracket.distance_before = distance;
      depth_m += std::clamp(distance * kStepShare, 1.0F, max_step_vox) * voxel_m_;
    } else if (in_free_space && max_step_vox > 1.0F) {
      // Perhaps a step through a surface seen at a grazing angle, whose distances are too large:
      // take it again in single voxels.
      max_step_vox = 1.0F;
      depth_m = bracket.before_m + voxel_m_;
    } else {
      in_free_space = false;
      depth_m = voxel ? depth_m + voxel_m_ : depth_of_block_exit(depth_m);
    }
  }
  return std::nullopt;
}

float RayMarcher::depth_of_block_exit(float depth_m) const {
  constexpr float kSide = kBlockSide;
  constexpr float kBeyond_vox = 0.01F;
  const Eigen::Vector3f point = ray_.at(depth_m);
  float advance_m = std::numeric_limits<float>::max();
  for (int axis = 0; axis < 3; ++axis) {
    const float direction = ray_.direction_vox_per_m[axis];
    if (direction == 0.0F) continue;
    const float lower = std::floor(point[axis] / kSide) * kSide;
    const float exit = direction > 0.0F ? lower + kSide : lower;
    advance_m = std::min(advance_m, (exit - point[axis]) * m_per_vox_[axis]);
  }
  return depth_m + std::max(advance_m, 0.0F) + kBeyond_vox * voxel_m_;
}

std::optional<float> RayMarcher::refine(const Bracket& bracket) {
  // The bracket's distances are those of the nearest voxels, so its first guess is up to a voxel
  // off: one Newton step with its slope, then one secant step through the two interpolated values.
  const float slope =
      (bracket.distance_after - bracket.distance_before) / (bracket.after_m - bracket.before_m);
  const auto step_m = [this](float distance, float slope) {
    return std::clamp(-distance / slope, -voxel_m_, voxel_m_);
  };
  const float first_m = bracket.before_m - bracket.distance_before / slope;
  const std::optional<float> at_first = sampler_.distance(ray_.at(first_m));
  if (!at_first) return std::nullopt;
  const float first = *at_first * truncation_vox_;

  const float second_m = first_m + step_m(first, slope);
  const std::optional<float> at_second = sampler_.distance(ray_.at(second_m));
  if (!at_second) return std::nullopt;
  const float second = *at_second * truncation_vox_;
  const float secant = (second - first) / (second_m - first_m);
  const bool usable = secant < 0.0F && std::isfinite(secant);
  return second_m + step_m(second, usable ? secant : slope);
}

}  // namespace kintsugi::mapper::testing
