#pragma once

#include <Eigen/Core>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// A pinhole camera at a pose, in single precision: for loops over pixels and blocks.
struct CameraView {
  /// @throws std::invalid_argument where the size or the focal length is not positive, a number is
  /// not finite or there is lens distortion
  CameraView(const Intrinsics& intrinsics, const Pose& X_WC);

  /// Of pixel (u, v), with unit z: times a depth in metres it is a point in C.
  Eigen::Vector3f ray_C(float u, float v) const { return {(u - cx) / fx, (v - cy) / fy, 1.0F}; }

  int width = 0;
  int height = 0;
  float fx = 0.0F;
  float fy = 0.0F;
  float cx = 0.0F;
  float cy = 0.0F;
  Eigen::Matrix3f R_WC;
  Eigen::Vector3f t_WC;
  Pose X_CW;  ///< in double precision: positions in W can be large
};

}  // namespace kintsugi::mapper
