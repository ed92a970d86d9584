#pragma once
// The deviation of a camera's depth, from many errors at many depths.

#include <array>

#include "mapper/core/frame/depth_noise.hpp"

namespace kintsugi::mapper {

/// Counts errors by depth and fits DepthNoise to them.
///
/// Each depth's deviation follows from a quantile of the errors' amounts, which gross errors beyond
/// it cannot carry away. The three terms of DepthNoise are fitted to these deviations by least
/// squares, none of them negative.
class DeviationByDepth {
 public:
  static constexpr double kNearest_m = 0.3;  ///< nearer depths are not counted

  /// `quantile`: the median or a larger one; where depth is rounded to steps wider than its noise,
  /// most errors may be zero.
  explicit DeviationByDepth(double quantile);

  /// All that was counted so far counts less from now on.
  void fade(double factor);

  /// @pre depth_m >= kNearest_m, error_m >= 0
  void count(double depth_m, double error_m);

  /// The deviations; at each depth `start` counts like `weight_of_start` errors.
  /// @param least of the deviation at each depth, as a share of that of `start`
  DepthNoise fit(const DepthNoise& start, double weight_of_start, double least) const;

 private:
  // Both ranges are divided evenly on a logarithmic scale: 0.3 to 10.7 m, 0.05 mm to 0.47 m.
  static constexpr int kDepthBins = 16;
  static constexpr double kDepthRatio = 1.25;
  static constexpr int kErrorBins = 96;
  static constexpr double kSmallest_m = 5e-5;
  static constexpr double kErrorRatio = 1.1;

  /// How often errors of each size were counted.
  using Histogram = std::array<double, kErrorBins>;

  double quantile_m(const Histogram& histogram, double total) const;

  double quantile_;
  double deviations_of_quantile_;  ///< of the amounts of normally distributed errors
  std::array<Histogram, kDepthBins> counts_{};
};

}  // namespace kintsugi::mapper
