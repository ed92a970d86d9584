#include "segmenter/evaluation/objects/pose_error.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace kintsugi::segmenter {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

using Rotations = std::vector<Eigen::Matrix3d>;

/// Adds what the turns make together, until nothing new comes.
void close(Rotations& group) {
  constexpr double kSame = 1e-6;
  constexpr std::size_t kMost = 60;  // the largest finite group of turns but for prisms
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (std::size_t j = 0; j <= i && group.size() < kMost; ++j) {
      const Eigen::Matrix3d both = group[i] * group[j];
      const bool is_known = std::ranges::any_of(
          group, [&](const Eigen::Matrix3d& known) { return (known - both).norm() < kSame; });
      if (!is_known) group.push_back(both);
    }
  }
}

Rotations finite_turns(const Symmetry& symmetry) {
  Rotations group = {Eigen::Matrix3d::Identity()};
  for (const SymmetryAxis& axis : symmetry.axes) {
    if (axis.order < 2) continue;
    group.push_back(Eigen::AngleAxisd(2.0 * std::numbers::pi / axis.order, axis.direction_G)
                        .toRotationMatrix());
  }
  close(group);
  return group;
}

/// The angle of R, or, with an axis about which any turn is allowed, that by which R tilts it.
double angle_deg(const Eigen::Matrix3d& R, const SymmetryAxis* free_axis) {
  if (free_axis == nullptr) return kDegPerRad * Eigen::AngleAxisd(R).angle();
  const double along = free_axis->direction_G.dot(R * free_axis->direction_G);
  return kDegPerRad * std::acos(std::clamp(along, -1.0, 1.0));
}

}  // namespace

PoseError pose_error(const Pose& X_WG_estimate, const Pose& X_WG_true, const Symmetry& symmetry) {
  PoseError error;
  error.translation_m = (X_WG_estimate * symmetry.centre_G - X_WG_true * symmetry.centre_G).norm();
  const auto is_free = [](const SymmetryAxis& axis) { return axis.order == 0; };
  if (std::ranges::count_if(symmetry.axes, is_free) > 1) return error;  // a ball
  const auto free = std::ranges::find_if(symmetry.axes, is_free);
  const SymmetryAxis* const free_axis = free == symmetry.axes.end() ? nullptr : &*free;
  const Eigen::Matrix3d R = X_WG_true.linear().transpose() * X_WG_estimate.linear();
  error.rotation_deg = std::numeric_limits<double>::infinity();
  for (const Eigen::Matrix3d& turn : finite_turns(symmetry)) {
    error.rotation_deg =
        std::min(error.rotation_deg, angle_deg(Eigen::Matrix3d(turn * R), free_axis));
  }
  return error;
}

}  // namespace kintsugi::segmenter
