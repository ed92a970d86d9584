#include "mapper/core/frame/local_noise.hpp"

#include <cmath>
#include <limits>

#include <tbb/parallel_for.h>

#include "mapper/core/frame/kernel_arguments.hpp"
#include "mapper/core/frame/same_surface.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kRowStep = 8;  ///< every so many rows are counted
/// What an image counts after each further one: 100 images remain in effect.
constexpr double kDecay = 0.99;
/// The start value counts like this share of an image: the first one already outweighs it.
constexpr double kImagesOfStart = 0.1;
constexpr double kLeastShare = 0.1;  ///< of the start value: rounding to millimetres

bool is_between(float before_m, float here_m, float after_m, float step_m) {
  const float from = here_m - before_m;
  const float to = after_m - here_m;
  return (from > step_m && to > step_m) || (from < -step_m && to < -step_m);
}

}  // namespace

void LocalNoiseEstimator::add(const cv::Mat_<float>& depth_m) {
  differences_.fade(kDecay);
  for (int v = 0; v < depth_m.rows; v += kRowStep) {
    const float* row = depth_m[v];
    for (int u = 1; u + 1 < depth_m.cols; ++u) {
      const float difference_m = std::abs(row[u - 1] - 2.0F * row[u] + row[u + 1]);
      if (!(row[u] >= static_cast<float>(DeviationByDepth::kNearest_m))) continue;
      if (!std::isfinite(difference_m)) continue;
      differences_.count(row[u], difference_m / std::sqrt(6.0F));
    }
  }
  const double counted_pixels = static_cast<double>(depth_m.total()) / kRowStep;
  noise_ = differences_.fit(DepthNoise(), kImagesOfStart * counted_pixels, kLeastShare);
}

cv::Mat_<float> without_mixed_pixels(const cv::Mat_<float>& depth_m, const Intrinsics& intrinsics,
                                     const DepthNoise& local_noise) {
  const DepthTolerance tolerance = depth_tolerance(local_noise, intrinsics);
  cv::Mat_<float> clean = depth_m.clone();
  tbb::parallel_for(1, depth_m.rows - 1, [&](int v) {
    const float* above = depth_m[v - 1];
    const float* row = depth_m[v];
    const float* below = depth_m[v + 1];
    for (int u = 1; u + 1 < depth_m.cols; ++u) {
      const float here_m = row[u];
      const auto is_mixed = [&](float step_m) {
        return is_between(row[u - 1], here_m, row[u + 1], step_m) ||
               is_between(above[u], here_m, below[u], step_m);
      };
      // The part without noise first: it is cheap, and few pixels pass it.
      if (is_mixed(tolerance.slope * here_m) && is_mixed(same_surface_m(tolerance, here_m, 1))) {
        clean(v, u) = std::numeric_limits<float>::quiet_NaN();
      }
    }
  });
  return clean;
}

}  // namespace kintsugi::mapper
