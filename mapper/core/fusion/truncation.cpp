#include "mapper/core/fusion/truncation.hpp"

#include <algorithm>
#include <cmath>

#include "mapper/core/frame/kernel_arguments.hpp"

namespace kintsugi::mapper {

TruncationByDepth truncation_by_depth(const TsdfVolume& volume, const DepthNoise& noise) {
  const TsdfVolume::Config& config = volume.config();
  const double sigmas_per_m =
      kTruncationSigmas / (config.resolution_m * config.largest_truncation_vox());
  return {.max_m = volume.max_truncation_m(),
          .inverse_max = 1.0F / volume.max_truncation_m(),
          .min_share = static_cast<float>(config.truncation_vox / config.largest_truncation_vox()),
          .sigmas_per_m = static_cast<float>(sigmas_per_m),
          .variance = depth_variance(noise)};
}

double range_of(const DepthNoise& noise, double max_truncation_m) {
  // sigma(z)^2 = sigma_m^2 is a quadratic equation of z^2.
  const double sigma_m = max_truncation_m / kRangeSigmas;
  const double a = noise.growth_per_m * noise.growth_per_m;
  const double b = noise.share * noise.share;
  const double c = std::max(sigma_m * sigma_m - noise.base_m * noise.base_m, 0.0);
  return std::sqrt(2.0 * c / (b + std::sqrt(b * b + 4.0 * a * c)));
}

}  // namespace kintsugi::mapper
