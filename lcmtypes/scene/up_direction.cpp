#include "lcmtypes/scene/up_direction.hpp"

#include <algorithm>
#include <cmath>

namespace kintsugi {
namespace {

/// Normals are rounded to multiples of 2^-20, so that sums of up to 2^32 of them are exact in
/// double precision: independent of the order of slices, and exactly undone by remove().
constexpr double kStepsPerUnit = 1 << 20;

/// Up, where the camera was held level at first.
const Eigen::Vector3d kLevel_W = -Eigen::Vector3d::UnitY();

/// Bin of a unit vector with y <= 0 in the octahedral map of the sphere (Meyer et al. 2010): the
/// half with y <= 0 is the whole of the square |a| + |b| <= 1 turned by 45 degrees.
int bin_of(const Eigen::Vector3d& n, int side) {
  const double norm1 = n.cwiseAbs().sum();
  const double a = n.x() / norm1;
  const double b = n.z() / norm1;
  const auto index = [side](double t) {
    return std::clamp(static_cast<int>((0.5 * t + 0.5) * side), 0, side - 1);
  };
  return index(a + b) * side + index(a - b);
}

/// Sum of the normals in bins within the cone about `axis` (xyz), and their number (w).
Eigen::Vector4d sum_in_cone(std::span<const Eigen::Vector4d> bins, const Eigen::Vector3d& axis,
                            double cos_half_angle) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const Eigen::Vector4d& bin : bins) {
    const double along = bin.head<3>().dot(axis);
    const double length = bin.head<3>().norm();
    if (length == 0.0) continue;
    // n and -n count alike: flip each bin to the side of the axis.
    if (std::abs(along) >= cos_half_angle * length) {
      sum.head<3>() += std::copysign(1.0, along) * bin.head<3>();
      sum.w() += bin.w();
    }
  }
  return sum;
}

}  // namespace

void UpDirection::add(std::span<const CloudPoint> points_W) { count(points_W, 1.0); }

void UpDirection::remove(std::span<const CloudPoint> points_W) { count(points_W, -1.0); }

void UpDirection::count(std::span<const CloudPoint> points_W, double sign) {
  if (!points_W.empty()) is_estimated_ = false;
  for (const CloudPoint& p : points_W) {
    Eigen::Vector3d normal(p.nx, p.ny, p.nz);
    if (!(std::abs(normal.squaredNorm() - 1.0) < 0.1)) continue;
    if (normal.y() > 0.0) normal = -normal;
    normal = (normal * kStepsPerUnit).array().round() / kStepsPerUnit;
    Eigen::Vector4d& bin = bins_[static_cast<std::size_t>(bin_of(normal, kSide))];
    bin.head<3>() += sign * normal;
    bin.w() += sign;
    total_ += sign;
  }
}

bool UpDirection::is_supported() const {
  if (!is_estimated_) up_W_ = estimate_W();
  is_estimated_ = true;
  return up_W_.has_value();
}

Eigen::Vector3d UpDirection::up_W() const { return is_supported() ? *up_W_ : kLevel_W; }

std::optional<Eigen::Vector3d> UpDirection::estimate_W() const {
  const double cos_tilt = std::cos(kMaxTilt_rad);
  const double cos_window = std::cos(0.2);

  Eigen::Vector3d up = kLevel_W;
  double best = 0.0;
  for (const Eigen::Vector4d& bin : bins_) {
    if (bin.w() == 0.0) continue;
    const Eigen::Vector3d candidate = bin.head<3>().normalized();
    if (candidate.dot(kLevel_W) < cos_tilt) continue;
    const double support = sum_in_cone(bins_, candidate, cos_window).w();
    if (support > best) {
      best = support;
      up = candidate;
    }
  }
  if (best == 0.0 || best < kMinShare * total_) return std::nullopt;
  for (int i = 0; i < 5; ++i) up = sum_in_cone(bins_, up, cos_window).head<3>().normalized();
  return up;
}

}  // namespace kintsugi
