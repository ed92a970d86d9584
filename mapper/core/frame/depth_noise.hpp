#pragma once

namespace kintsugi::mapper {

/// Standard deviation of a camera's depth, which grows with the square of the depth where depth
/// comes from a disparity. The default is that of the first Kinect (Khoshelham and Elberink 2012:
/// 1.4 mm at 1 m, 4 cm at 5 m).
struct DepthNoise {
  double base_m = 0.0012;        ///< at depth zero
  double growth_per_m = 0.0015;  ///< by this times the depth squared, metres

  double sigma_m(double z_m) const { return base_m + growth_per_m * z_m * z_m; }
};

}  // namespace kintsugi::mapper
