#pragma once

#include <cmath>

namespace kintsugi::mapper {

/// Standard deviation of a camera's depth at depth z (metres), from three independent errors:
///   sigma(z)^2 = base_m^2 + (share z)^2 + (growth_per_m z^2)^2.
/// Rounding and the map's voxels give a constant one; time of flight and scale, one that grows with
/// z; triangulation (structured light, stereo), one that grows with its square.
struct DepthNoise {
  // The default is within 1 mm of that of Nguyen et al. 2012 for structured light, 0.0012 + 0.0019
  // (z - 0.4)^2 m, from 0.4 to 5 m.
  double base_m = 0.0012;         ///< >= 0
  double share = 0.0;             ///< of z, >= 0
  double growth_per_m = 0.00165;  ///< 1/m, >= 0

  double variance_m2(double z_m) const {
    const double z2 = z_m * z_m;
    return base_m * base_m + z2 * (share * share + z2 * growth_per_m * growth_per_m);
  }
  double sigma_m(double z_m) const { return std::sqrt(variance_m2(z_m)); }
};

/// The two kinds of noise of a camera.
struct SensorNoise {
  DepthNoise depth;  ///< of a depth against the true one
  DepthNoise local;  ///< of neighbouring depths against each other
};

}  // namespace kintsugi::mapper
