#pragma once

#include <Eigen/Geometry>
#include <span>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::viewer {

/// A pinhole camera V that looks at the map; x right, y down, z forward, no lens distortion.
struct VirtualCamera {
  Intrinsics intrinsics;
  Pose X_WV = Pose::Identity();
};

/// Intrinsics of a picture that sees `field_of_view_rad` along its longer side.
/// Throws std::invalid_argument for a size below 1 pixel or an angle outside (0, pi).
Intrinsics pinhole(int width, int height, double field_of_view_rad);

/// X_WV of a camera at `eye_W` whose z goes through `target_W` and whose -y is as near to `up_W` as
/// that allows. A target at the eye, or straight above or below it, gives some camera with that z.
Pose look_at(const Eigen::Vector3d& eye_W, const Eigen::Vector3d& target_W,
             const Eigen::Vector3d& up_W);

/// The camera with this orientation, as near as it may be, that sees the points with `margin_px` to
/// spare on every side and none of them closer than 1 m along its z. Up to a share `outliers` of
/// them may stay out at each side. `points_W` must not be empty.
VirtualCamera fit_points(std::span<const Eigen::Vector3d> points_W, double outliers,
                         const Eigen::Matrix3d& R_WV, const Intrinsics& intrinsics,
                         double margin_px);

/// R_WV of a camera that looks down by `pitch_rad` below the horizon, turned by `yaw_rad` about up
/// (to the left) from the forward direction of W's first camera.
Eigen::Matrix3d look_down(const Eigen::Vector3d& up_W, double yaw_rad, double pitch_rad);

}  // namespace kintsugi::viewer
