#pragma once
// Learns the noise of a camera's depth from the residuals of tracking.

#include <array>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/depth_noise.hpp"
#include "mapper/core/frame/surface_map.hpp"

namespace kintsugi::mapper {

/// Estimates DepthNoise from how far the points of registered frames are from the model.
///
/// The residuals, along the camera's z, are counted by depth. Each depth's deviation is 1.4826 times
/// the median of their amounts, which up to half of wrong pairs cannot carry away, and the three
/// terms of DepthNoise are fitted to these deviations by least squares, none of them negative.
/// The start value counts like a few images, and it is the least value: the residuals of a camera that
/// is more precise are those of the model, which the same weights suit. Older frames count less and
/// less, so that the estimate follows a camera that warms up.
class NoiseEstimator {
 public:
  explicit NoiseEstimator(const DepthNoise& start) : start_(start), noise_(start) {}

  /// Counts a frame that was registered with a model: V is the model's camera, C the frame's.
  void add(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC);

  const DepthNoise& noise() const { return noise_; }

 private:
  // Both ranges are divided evenly on a logarithmic scale: 0.3 to 10.7 m, 0.05 mm to 0.47 m.
  static constexpr int kDepthBins = 16;
  static constexpr double kNearest_m = 0.3;
  static constexpr double kDepthRatio = 1.25;
  static constexpr int kResidualBins = 96;
  static constexpr double kSmallest_m = 5e-5;
  static constexpr double kResidualRatio = 1.1;

  /// How often residuals of each size were seen.
  using Histogram = std::array<double, kResidualBins>;

  static double depth_of_bin_m(int bin);
  static double median_m(const Histogram& histogram, double total);
  DepthNoise fit(double pixels_of_an_image) const;

  DepthNoise start_;
  DepthNoise noise_;
  std::array<Histogram, kDepthBins> counts_{};
};

}  // namespace kintsugi::mapper
