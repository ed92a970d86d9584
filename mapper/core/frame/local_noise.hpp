#pragma once
// How much the depths of neighbouring pixels scatter, and pixels that lie between two surfaces.

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/depth_noise.hpp"
#include "mapper/core/frame/deviation_by_depth.hpp"

namespace kintsugi::mapper {

/// Estimates the noise of single pixels against their neighbours, from the images alone: the second
/// difference of three neighbouring depths is zero on a plane, so that its deviation is sqrt(6)
/// times that of a depth. A camera that interpolates or matches windows has errors that many pixels
/// share: their scatter is much smaller than DepthNoise of the whole, and tells neighbours on
/// different surfaces apart where that would not.
class LocalNoiseEstimator {
 public:
  /// Counts some rows of a depth image (metres, invalid is NaN).
  void add(const cv::Mat_<float>& depth_m);

  const DepthNoise& noise() const { return noise_; }

 private:
  DepthNoise noise_;
  DeviationByDepth differences_{0.8};
};

/// The image without pixels whose depth lies between those of their two neighbours in the row or
/// the column, and on the surface of neither (see DepthTolerance, of `local_noise`): the camera
/// mixed the two.
cv::Mat_<float> without_mixed_pixels(const cv::Mat_<float>& depth_m, const Intrinsics& intrinsics,
                                     const DepthNoise& local_noise);

}  // namespace kintsugi::mapper
