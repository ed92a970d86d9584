#pragma once

#include <Eigen/Core>
#include <limits>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/depth_noise.hpp"

namespace kintsugi::mapper {

/// An image of surface points and normals in the frame of its camera, from a depth image or by
/// raycasting the volume. The point of a pixel is the back-projection of its depth.
///
/// Four separate planes of the size of `intrinsics`, so that neighbouring pixels fill a vector
/// register.
struct SurfaceMap {
  Intrinsics intrinsics;     ///< without distortion
  DepthNoise noise;          ///< of measured depths; of a raycast surface not used
  DepthNoise local_noise;    ///< of neighbouring depths against each other
  cv::Mat_<float> depth_m;   ///< height x width, along the camera's z; invalid is NaN
  cv::Mat_<float> normal_x;  ///< unit normal towards the camera; invalid is NaN in all three
  cv::Mat_<float> normal_y;
  cv::Mat_<float> normal_z;

  SurfaceMap() = default;

  /// Allocates planes of the camera's size; their values are uninitialised.
  explicit SurfaceMap(const Intrinsics& camera)
      : intrinsics(camera),
        depth_m(camera.height, camera.width),
        normal_x(camera.height, camera.width),
        normal_y(camera.height, camera.width),
        normal_z(camera.height, camera.width) {}

  /// Point of a pixel, metres; NaN in all three coordinates where its depth is invalid. This and
  /// the two functions below are slow: kernels use planes_of().
  Eigen::Vector3f point(int v, int u) const {
    const float z = depth_m(v, u);
    return {z * static_cast<float>((u - intrinsics.cx) / intrinsics.fx),
            z * static_cast<float>((v - intrinsics.cy) / intrinsics.fy), z};
  }
  Eigen::Vector3f normal(int v, int u) const {
    return {normal_x(v, u), normal_y(v, u), normal_z(v, u)};
  }
  void set_normal(int v, int u, const Eigen::Vector3f& normal) {
    normal_x(v, u) = normal.x();
    normal_y(v, u) = normal.y();
    normal_z(v, u) = normal.z();
  }
};

}  // namespace kintsugi::mapper
