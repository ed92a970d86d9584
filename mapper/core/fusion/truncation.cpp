#include "mapper/core/fusion/truncation.hpp"

#include <algorithm>
#include <cmath>

namespace kintsugi::mapper {

TruncationByDepth truncation_by_depth(const TsdfVolume& volume, const DepthNoise& noise) {
  const TsdfVolume::Config& config = volume.config();
  const double sigmas_per_m =
      kTruncationSigmas / (config.resolution_m * config.largest_truncation_vox());
  return {.max_m = volume.max_truncation_m(),
          .inverse_max = 1.0F / volume.max_truncation_m(),
          .min_share = static_cast<float>(config.truncation_vox / config.largest_truncation_vox()),
          .base_share = static_cast<float>(noise.base_m * sigmas_per_m),
          .growth_share_per_m2 = static_cast<float>(noise.growth_per_m * sigmas_per_m)};
}

double range_of(const DepthNoise& noise, double max_truncation_m) {
  const double growth_m = max_truncation_m / kTruncationSigmas - noise.base_m;
  return std::sqrt(std::max(growth_m, 0.0) / noise.growth_per_m);
}

}  // namespace kintsugi::mapper
