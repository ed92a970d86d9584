#pragma once

#include <Eigen/Geometry>
#include <span>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::viewer {

/// The camera V from which a picture is drawn: a pinhole without lens distortion; x right, y down,
/// z forward.
struct VirtualCamera {
  Intrinsics intrinsics;
  Pose X_WV = Pose::Identity();
};

/// Intrinsics of a picture with the angle `field_of_view_rad` along its longer side.
/// @throws std::invalid_argument for a size below 1 pixel or an angle outside (0, pi)
Intrinsics pinhole(int width, int height, double field_of_view_rad);

/// X_WV of a camera at `eye_W` whose z axis goes through `target_W` and whose -y axis is as near to
/// `up_W` as possible. When target and eye coincide, z is W's z; when the target is straight above
/// or below, -y is any direction perpendicular to z.
Pose look_at(const Eigen::Vector3d& eye_W, const Eigen::Vector3d& target_W,
             const Eigen::Vector3d& up_W);

/// The camera with this orientation, as near as possible, in whose picture the points are at least
/// `margin_px` from every edge and 1 m away along its z. Beyond each of these five limits may be a
/// share `outliers` of `points_W`, but none of `all_of_these_W`; one of them must not be empty.
VirtualCamera fit_points(std::span<const Eigen::Vector3d> points_W, double outliers,
                         const Eigen::Matrix3d& R_WV, const Intrinsics& intrinsics,
                         double margin_px, std::span<const Eigen::Vector3d> all_of_these_W = {});

/// R_WV of a camera that looks `pitch_rad` below the horizon, turned to the left by `yaw_rad` about
/// `up_W` from W's z, the viewing direction of the first camera pose.
Eigen::Matrix3d look_down(const Eigen::Vector3d& up_W, double yaw_rad, double pitch_rad);

}  // namespace kintsugi::viewer
