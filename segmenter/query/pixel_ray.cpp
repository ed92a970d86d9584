#include "segmenter/query/pixel_ray.hpp"

#include <sstream>
#include <stdexcept>

namespace kintsugi::segmenter {
namespace {

/// The Brown-Conrady model: maps undistorted to distorted normalised image coordinates.
Eigen::Vector2d distorted(const std::array<double, 5>& lens, const Eigen::Vector2d& x) {
  const auto [k1, k2, p1, p2, k3] = lens;
  const double r2 = x.squaredNorm();
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double xy = x.x() * x.y();
  return {x.x() * radial + 2.0 * p1 * xy + p2 * (r2 + 2.0 * x.x() * x.x()),
          x.y() * radial + p1 * (r2 + 2.0 * x.y() * x.y()) + 2.0 * p2 * xy};
}

/// Solves distorted(x) = seen. False when the iteration does not converge.
bool undistort(const std::array<double, 5>& lens, const Eigen::Vector2d& seen, Eigen::Vector2d& x) {
  constexpr int kMaxIterations = 100;
  constexpr double kTolerance = 1e-9;  // a millionth of a pixel
  x = seen;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::Vector2d error = seen - distorted(lens, x);
    if (error.norm() <= kTolerance) return true;
    x += error;
  }
  return false;
}

[[noreturn]] void refuse(double u_px, double v_px, const std::string& why) {
  std::ostringstream text;
  text << "pixel (" << u_px << ", " << v_px << ") " << why;
  throw std::invalid_argument(text.str());
}

}  // namespace

Intrinsics kinect_intrinsics() {
  return {.fx = 525, .fy = 525, .cx = 319.5, .cy = 239.5, .width = 640, .height = 480};
}

void check_pixel(const Intrinsics& intrinsics, double u_px, double v_px) {
  // Integer coordinates are pixel centres: the image ends half a pixel beyond them.
  const bool is_inside = u_px >= -0.5 && u_px <= intrinsics.width - 0.5 && v_px >= -0.5 &&
                         v_px <= intrinsics.height - 0.5;
  if (is_inside) return;
  refuse(u_px, v_px,
         "is outside the image of " + std::to_string(intrinsics.width) + " x " +
             std::to_string(intrinsics.height));
}

Ray pixel_ray(const Intrinsics& intrinsics, const Pose& X_WC, double u_px, double v_px) {
  check_pixel(intrinsics, u_px, v_px);
  const Eigen::Vector2d seen((u_px - intrinsics.cx) / intrinsics.fx,
                             (v_px - intrinsics.cy) / intrinsics.fy);
  Eigen::Vector2d x;
  if (!undistort(intrinsics.distortion, seen, x)) {
    refuse(u_px, v_px, "is where the lens model cannot be inverted");
  }
  return {X_WC.translation(), X_WC.linear() * x.homogeneous().normalized()};
}

}  // namespace kintsugi::segmenter
