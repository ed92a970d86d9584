#include "viewer/core/camera/virtual_camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::viewer {
namespace {

/// A unit vector perpendicular to the unit vector `v`.
Eigen::Vector3d any_perpendicular(const Eigen::Vector3d& v) {
  const Eigen::Vector3d other =
      std::abs(v.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  return v.cross(other).normalized();
}

Eigen::Matrix3d rotation_along(const Eigen::Vector3d& forward_W, const Eigen::Vector3d& up_W) {
  const Eigen::Vector3d z = forward_W.normalized();
  const Eigen::Vector3d side = z.cross(up_W);
  const Eigen::Vector3d x = side.norm() > 1e-6 ? side.normalized() : any_perpendicular(z);
  Eigen::Matrix3d R_WV;
  R_WV << x, z.cross(x), z;
  return R_WV;
}

/// The quantile `share` of the coordinates along `axis`; infinity without points.
double low_quantile(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& axis,
                    double share) {
  if (points.empty()) return std::numeric_limits<double>::infinity();
  std::vector<double> along(points.size());
  std::ranges::transform(points, along.begin(), [&](const auto& p) { return p.dot(axis); });
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(points.size()));
  std::ranges::nth_element(along, along.begin() + rank);
  return along[static_cast<std::size_t>(rank)];
}

}  // namespace

Intrinsics pinhole(int width, int height, double field_of_view_rad) {
  require(width >= 1, "width of the picture", width, ">= 1 px");
  require(height >= 1, "height of the picture", height, ">= 1 px");
  require(field_of_view_rad > 0.0 && field_of_view_rad < std::numbers::pi, "field_of_view_rad",
          field_of_view_rad, "in (0, pi)");
  const double f = 0.5 * std::max(width, height) / std::tan(0.5 * field_of_view_rad);
  return {.fx = f,
          .fy = f,
          .cx = 0.5 * (width - 1),
          .cy = 0.5 * (height - 1),
          .width = width,
          .height = height};
}

Pose look_at(const Eigen::Vector3d& eye_W, const Eigen::Vector3d& target_W,
             const Eigen::Vector3d& up_W) {
  const Eigen::Vector3d forward_W = target_W - eye_W;
  Pose X_WV = Pose::Identity();
  X_WV.linear() =
      rotation_along(forward_W.norm() > 1e-9 ? forward_W : Eigen::Vector3d::UnitZ(), up_W);
  X_WV.translation() = eye_W;
  return X_WV;
}

VirtualCamera fit_points(std::span<const Eigen::Vector3d> points_W, double outliers,
                         const Eigen::Matrix3d& R_WV, const Intrinsics& intrinsics,
                         double margin_px, std::span<const Eigen::Vector3d> all_of_these_W) {
  // A point (x, y, z) in V's axes is in the picture of an eye at (a, b, c) when |x - a| <= (z - c)
  // sx, that is x - z sx <= a - c sx and a + c sx <= x + z sx; likewise for b.
  const double sx = std::max(0.5 * intrinsics.width - margin_px, 1.0) / intrinsics.fx;
  const double sy = std::max(0.5 * intrinsics.height - margin_px, 1.0) / intrinsics.fy;
  const Eigen::Vector3d x = R_WV.col(0);
  const Eigen::Vector3d y = R_WV.col(1);
  const Eigen::Vector3d z = R_WV.col(2);
  const auto lowest = [&](const Eigen::Vector3d& axis) {
    return std::min(low_quantile(points_W, axis, outliers),
                    low_quantile(all_of_these_W, axis, 0.0));
  };
  const double right = -lowest(sx * z - x);
  const double left = lowest(sx * z + x);
  const double bottom = -lowest(sy * z - y);
  const double top = lowest(sy * z + y);
  constexpr double kNearest_m = 1.0;
  const double c =
      std::min({(left - right) / (2.0 * sx), (top - bottom) / (2.0 * sy), lowest(z) - kNearest_m});
  const Eigen::Vector3d eye_V(0.5 * (left + right), 0.5 * (top + bottom), c);
  VirtualCamera camera{intrinsics, Pose::Identity()};
  camera.X_WV.linear() = R_WV;
  camera.X_WV.translation() = R_WV * eye_V;
  return camera;
}

Eigen::Matrix3d look_down(const Eigen::Vector3d& up_W, double yaw_rad, double pitch_rad) {
  Eigen::Vector3d forward_W = Eigen::Vector3d::UnitZ() - up_W.z() * up_W;
  forward_W = forward_W.norm() > 1e-6 ? forward_W.normalized() : any_perpendicular(up_W);
  forward_W = Eigen::AngleAxisd(yaw_rad, up_W) * forward_W;
  return rotation_along(std::cos(pitch_rad) * forward_W - std::sin(pitch_rad) * up_W, up_W);
}

}  // namespace kintsugi::viewer
