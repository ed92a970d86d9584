#pragma once
// A room in closed form for the tracking tests: the inside of a box with a smaller box standing in
// it, seen by a pinhole camera. No noise; depth, point and normal of each pixel are exact.

#include <cmath>
#include <limits>

#include <opencv2/core.hpp>

#include "mapper/core/frame/surface_map.hpp"

namespace kintsugi::mapper::testing {

struct Box {
  Eigen::Vector3d min_W;
  Eigen::Vector3d max_W;
};

inline const Box kRoom{{-2.0, -1.4, -2.0}, {2.2, 1.3, 2.4}};
inline const Box kCrate{{-0.5, 0.5, 1.2}, {0.3, 1.3, 1.9}};

inline Intrinsics test_camera(int width = 320, int height = 240) {
  const double f = 0.85 * width;
  return {f, f, 0.5 * width - 0.5, 0.5 * height - 0.5, width, height, {}};
}

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();
};

/// Where the ray enters (from outside) or leaves (from inside) the box, by the slab method.
inline Hit intersect(const Box& box, const Eigen::Vector3d& origin_W, const Eigen::Vector3d& ray_W,
                     bool inside) {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  int enter_axis = 0;
  int leave_axis = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.min_W[axis] - origin_W[axis]) / ray_W[axis];
    const double b = (box.max_W[axis] - origin_W[axis]) / ray_W[axis];
    if (std::min(a, b) > enter) enter = std::min(a, b), enter_axis = axis;
    if (std::max(a, b) < leave) leave = std::max(a, b), leave_axis = axis;
  }
  if (enter > leave || leave <= 0.0 || (!inside && enter <= 0.0)) return {};
  Hit hit;
  hit.distance = inside ? leave : enter;
  const int axis = inside ? leave_axis : enter_axis;
  hit.normal_W[axis] = ray_W[axis] > 0.0 ? -1.0 : 1.0;  // against the ray
  return hit;
}

/// The exact surface seen from X_WC.
inline SurfaceMap render_room(const Pose& X_WC, const Intrinsics& camera) {
  SurfaceMap surface(camera);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray_C((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1.0);
      const Eigen::Vector3d ray_W = X_WC.linear() * ray_C;
      const Hit wall = intersect(kRoom, X_WC.translation(), ray_W, true);
      const Hit crate = intersect(kCrate, X_WC.translation(), ray_W, false);
      const Hit& hit = crate.distance < wall.distance ? crate : wall;
      surface.depth_m(v, u) = static_cast<float>(hit.distance);  // the ray has unit z
      surface.set_normal(v, u, (X_WC.linear().transpose() * hit.normal_W).cast<float>());
    }
  }
  return surface;
}

inline cv::Mat_<float> render_depth(const Pose& X_WC, const Intrinsics& camera) {
  return render_room(X_WC, camera).depth_m;
}

/// Looks into the corner of the room with the crate in view.
inline Pose looking_at_the_crate() {
  Pose X_WC = Pose::Identity();
  X_WC.translation() << 0.2, -0.1, -1.0;
  X_WC.linear() = (Eigen::AngleAxisd(0.25, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(-0.35, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return X_WC;
}

inline double distance_m(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm();
}

inline double angle_rad(const Pose& a, const Pose& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

}  // namespace kintsugi::mapper::testing
