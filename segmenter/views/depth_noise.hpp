#pragma once
// How well a depth camera measures.

#include <cmath>

namespace kintsugi::segmenter {

/// Standard deviation of the depth that a structured-light camera measures at depth z, metres: what
/// rounding gives, and what triangulation gives, which grows with the square. Within 1 mm of that
/// of Nguyen et al. (3DIMPVT 2012) from 0.4 to 5 m, and larger than that of time of flight.
inline double depth_sigma_m(double z_m) {
  constexpr double kBase_m = 0.0012;
  constexpr double kGrowth_per_m = 0.00165;
  const double growth_m = kGrowth_per_m * z_m * z_m;
  return std::sqrt(kBase_m * kBase_m + growth_m * growth_m);
}

}  // namespace kintsugi::segmenter
