#pragma once

#include <algorithm>
#include <cmath>

#include "mapper/core/frame/depth_noise.hpp"
#include "mapper/core/kernels/integration.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Distances are truncated at this many standard deviations of the depth, where that is more than
/// the volume's smallest truncation distance: all but 0.3 % of the measurements of a surface then
/// reach the voxels on both sides of it, so that their mean is one surface, in the right place.
inline constexpr double kTruncationSigmas = 3.0;

TruncationByDepth truncation_by_depth(const TsdfVolume& volume, const DepthNoise& noise);

/// In metres; never falls with the depth.
inline float truncation_at(float depth_m, const TruncationByDepth& truncation) {
  const float squared = depth_m * depth_m;
  const float* c = truncation.variance.c;
  const float share = truncation.sigmas_per_m * std::sqrt(c[0] + squared * (c[1] + squared * c[2]));
  return std::clamp(share, truncation.min_share, 1.0F) * truncation.max_m;
}

/// Depth is used as far as the largest truncation distance is this many of its deviations: of the
/// measurements of a surface 95 % still reach the voxels on both sides of it.
inline constexpr double kRangeSigmas = 2.0;

/// The depth up to which kRangeSigmas holds. Infinite for a camera without noise.
double range_of(const DepthNoise& noise, double max_truncation_m);

}  // namespace kintsugi::mapper
