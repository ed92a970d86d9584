#pragma once
// Random fields whose neighbouring values are alike.

#include <Eigen/Core>
#include <cstdint>

#include <opencv2/core.hpp>

namespace kintsugi::synthetic {

/// Standard normal noise of every pixel, averaged over a square window of `window_px` (odd, >= 1)
/// and scaled back to variance 1: what is dx and dy pixels apart has the correlation
/// (1 - |dx| / w) (1 - |dy| / w), none beyond the window. The sums are of integers: exact.
cv::Mat_<float> windowed_noise(cv::Size size, int window_px, std::uint32_t seed);

/// Standard normal values at the nodes of a grid, `cell_px` apart, interpolated between them and
/// scaled to variance 1 everywhere.
class GridNoise {
 public:
  GridNoise(double cell_px, std::uint32_t seed) : cell_px_(cell_px), seed_(seed) {}

  double at(double v, double u) const;

 private:
  double cell_px_;
  std::uint32_t seed_;
};

/// Patches in space, about `size_m` across, that cover the share `share` of it.
class Patches {
 public:
  Patches(double size_m, double share, std::uint32_t seed);

  /// Positive within a patch, and the larger the further from its border; about 0.3 at most.
  float depth_within(const Eigen::Vector3f& p_W) const { return value(p_W) - threshold_; }

 private:
  float value(const Eigen::Vector3f& p_W) const;  // in [0, 1]

  float cells_per_m_;
  std::uint32_t seed_;
  float threshold_ = 0.0F;
};

}  // namespace kintsugi::synthetic
