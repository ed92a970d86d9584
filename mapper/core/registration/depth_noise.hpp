#pragma once

namespace kintsugi::mapper {

/// Standard deviation of a structured-light camera's depth at depth z (metres), after Nguyen et al.
/// 2012: 0.0012 + 0.0019 (z - 0.4)^2 metres.
inline constexpr double kDepthSigmaBase_m = 0.0012;
inline constexpr double kDepthSigmaGrowth_per_m = 0.0019;
inline constexpr double kDepthSigmaNearest_m = 0.4;
inline double depth_sigma_m(double z_m) {
  const double from_nearest_m = z_m - kDepthSigmaNearest_m;
  return kDepthSigmaBase_m + kDepthSigmaGrowth_per_m * from_nearest_m * from_nearest_m;
}

}  // namespace kintsugi::mapper
