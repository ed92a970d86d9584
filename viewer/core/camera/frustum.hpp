#pragma once

#include <Eigen/Core>
#include <array>

#include "lcmtypes/geometry.hpp"
#include "viewer/core/camera/virtual_camera.hpp"

namespace kintsugi::viewer {

/// The pyramid that is drawn for the depth camera.
struct Frustum {
  Eigen::Vector3d apex_W = Eigen::Vector3d::Zero();  ///< the camera, metres
  std::array<Eigen::Vector3d, 4> base_W;             ///< corners of the picture, in its order

  /// The apex and the corners of the base.
  std::array<Eigen::Vector3d, 5> corners_W() const {
    return {apex_W, base_W[0], base_W[1], base_W[2], base_W[3]};
  }
};

/// `size_m`: from the apex to the base.
Frustum frustum_of(const Pose& X_WC, double size_m);

/// The whole frustum is in the picture.
bool is_in_picture(const Frustum& frustum, const VirtualCamera& camera);

}  // namespace kintsugi::viewer
