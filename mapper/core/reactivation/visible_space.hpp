#pragma once

#include <Eigen/Core>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// The space between the camera and the surface that it measures, and a little more: what a frame
/// changes is inside.
class VisibleSpace {
 public:
  /// `depth_m`: NaN where it is invalid. `margin_m`: how far behind the surface it ends.
  VisibleSpace(const cv::Mat_<float>& depth_m, const Intrinsics& camera, const Pose& X_UC,
               double margin_m);

  /// Whether part of a ball may be inside.
  bool meets(const Eigen::Vector3d& center_U, double radius_m) const;

 private:
  Intrinsics camera_;
  Pose X_CU_;
  double margin_m_;
  double longest_m_ = 0.0;
  cv::Mat_<float> farthest_m_;  ///< of each cell of pixels; 0: nothing was measured there
};

}  // namespace kintsugi::mapper
