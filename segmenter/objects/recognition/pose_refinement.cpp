#include "segmenter/objects/recognition/pose_refinement.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace kintsugi::segmenter {

namespace {

constexpr int kIterations = 12;
// Of a point-to-point residual beside one to the plane: along the surface a point has no
// counterpart of its own, only one within half a spacing.
constexpr double kPointWeight = 0.1;

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

struct Match {
  const SurfacePoint* model;
  const SurfacePoint* seen;
  Eigen::Vector3f seen_O;
};

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

LightChange light_change(const std::vector<Match>& matches) {
  // The logarithm of what is dark is noise.
  constexpr float kDark = 0.002F;
  std::array<std::vector<float>, 3> differences;
  for (const Match& match : matches) {
    if (!match.model->has_color || !match.seen->has_color) continue;
    for (int k = 0; k < 3; ++k) {
      differences[static_cast<std::size_t>(k)].push_back(
          std::log((match.seen->rgb[k] + kDark) / (match.model->rgb[k] + kDark)));
    }
  }
  LightChange light;
  if (differences[0].empty()) return light;
  for (int k = 0; k < 3; ++k) light.log_gain[k] = median(differences[static_cast<std::size_t>(k)]);
  light.limit();
  return light;
}

/// The points that have a counterpart within `reach_m`.
std::vector<Match> matches_of(const PreparedModel& model, const Surface& seen_W, const Pose& X_OW,
                              float reach_m) {
  const Eigen::Isometry3f X = X_OW.cast<float>();
  std::vector<Match> matches;
  matches.reserve(seen_W.size());
  for (const SurfacePoint& seen : seen_W) {
    const Eigen::Vector3f p = X * seen.position;
    const std::int32_t nearest = model.field.nearest(p);
    if (nearest < 0) continue;
    const SurfacePoint& q = model.surface_O[static_cast<std::size_t>(nearest)];
    if ((p - q.position).squaredNorm() > reach_m * reach_m) continue;
    if (q.normal.dot(X.linear() * seen.normal) < kSameNormal) continue;
    matches.push_back({&q, &seen, p});
  }
  return matches;
}

void keep_colors(std::vector<Match>& matches, const LightChange& light) {
  std::erase_if(matches, [&light](const Match& match) {
    return !same_color(*match.model, *match.seen, light);
  });
}

/// The small motion of the points seen, in O, that brings them onto the model.
Vector6d step_O(const std::vector<Match>& matches) {
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  for (const Match& match : matches) {
    const Eigen::Vector3d p = match.seen_O.cast<double>();
    const Eigen::Vector3d difference = match.model->position.cast<double>() - p;
    const Eigen::Vector3d n = match.model->normal.cast<double>();
    Vector6d J;
    J << n, p.cross(n);
    H += J * J.transpose();
    b += J * n.dot(difference);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
      J << axis, p.cross(axis);
      H += kPointWeight * J * J.transpose();
      b += kPointWeight * J * difference[k];
    }
  }
  H.diagonal().array() += 1e-9;
  return H.ldlt().solve(b);
}

}  // namespace

PoseHypothesis refined_pose(const PreparedModel& model, const Surface& seen_W, const Pose& X_WO) {
  PoseHypothesis result;
  Pose X_OW = X_WO.inverse();
  constexpr std::size_t kFewest = 6;  // what six unknowns take
  for (int i = 0; i < kIterations; ++i) {
    // From a few spacings down to what counts as the same.
    const float reach_m =
        std::max(kSameDistance, 4.0F - static_cast<float>(i) * 0.4F) * model.spacing_m;
    std::vector<Match> matches = matches_of(model, seen_W, X_OW, reach_m);
    result.light = light_change(matches);
    keep_colors(matches, result.light);
    if (matches.size() < kFewest) break;
    // Within the largest reach a pose that is right has nearly all points.
    if (i == 3 && static_cast<float>(matches.size()) < 0.4F * static_cast<float>(seen_W.size())) {
      break;
    }
    const Vector6d step = step_O(matches);
    Pose motion = Pose::Identity();
    const double angle = step.tail<3>().norm();
    if (angle > 0.0) {
      motion.linear() = Eigen::AngleAxisd(angle, step.tail<3>() / angle).toRotationMatrix();
    }
    motion.translation() = step.head<3>();
    X_OW = motion * X_OW;
    const bool is_done = reach_m <= kSameDistance * model.spacing_m * 1.001F &&
                         step.head<3>().norm() + angle * model.radius_m < 1e-4;
    if (is_done) break;
  }
  X_OW.linear() = Eigen::Quaterniond(X_OW.linear()).normalized().toRotationMatrix();
  result.X_WO = X_OW.inverse();
  std::vector<Match> matches = matches_of(model, seen_W, X_OW, kSameDistance * model.spacing_m);
  result.light = light_change(matches);
  keep_colors(matches, result.light);
  result.agreement = seen_W.empty()
                         ? 0.0F
                         : static_cast<float>(matches.size()) / static_cast<float>(seen_W.size());
  return result;
}

}  // namespace kintsugi::segmenter
