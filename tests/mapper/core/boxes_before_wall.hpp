#pragma once
// Boxes before a wall in closed form, seen by a pinhole camera.

#include <vector>

#include "mapper/core/registration/twist.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper::testing {

/// The exact surface of boxes before the wall z = wall_m.
inline SurfaceMap render_before_wall(const std::vector<Box>& boxes, double wall_m,
                                     const Pose& X_WC) {
  const Intrinsics camera = test_camera();
  SurfaceMap surface(camera);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray_C((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
      const Eigen::Vector3d ray_W = X_WC.linear() * ray_C;
      Hit hit{(wall_m - X_WC.translation().z()) / ray_W.z(), -Eigen::Vector3d::UnitZ()};
      for (const Box& box : boxes) {
        const Hit other = intersect(box, X_WC.translation(), ray_W, false);
        if (other.distance < hit.distance) hit = other;
      }
      surface.depth_m(v, u) = static_cast<float>(hit.distance);
      surface.set_normal(v, u, (X_WC.linear().transpose() * hit.normal_W).cast<float>());
    }
  }
  return surface;
}

/// A wall 2 m ahead with upright slats, 5 cm wide and high, every 10 cm, and rails across.
inline SurfaceMap render_slats(const Pose& X_WC) {
  constexpr double kWall_m = 2.0;
  constexpr double kHeight_m = 0.05;
  std::vector<Box> boxes;
  for (int i = -8; i <= 8; ++i) {
    boxes.push_back({{0.1 * i, -5.0, kWall_m - kHeight_m}, {0.1 * i + 0.05, 5.0, kWall_m}});
  }
  for (int i = -3; i <= 2; ++i) {
    boxes.push_back({{-5.0, 0.4 * i, kWall_m - kHeight_m}, {5.0, 0.4 * i + 0.1, kWall_m}});
  }
  return render_before_wall(boxes, kWall_m, X_WC);
}

/// The camera has gone on by 2 cm before the slats, or by a share of that.
inline Pose gone_on_before_slats(double share = 1.0) {
  Vector6d motion;
  motion << 0.02, 0.007, -0.005, 0.004, 0.006, 0.002;
  return se3_retract(share * motion);
}

}  // namespace kintsugi::mapper::testing
