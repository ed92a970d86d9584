#include "segmenter/objects/recognition/pose_refinement.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "segmenter/objects/recognition/lit_model.hpp"

namespace kintsugi::segmenter {

namespace {

// The reach shrinks from a few spacings down to what counts as the same.
constexpr int kIterations = 12;
constexpr int kRoughIterations = 4;
// Of a point-to-point residual beside one to the plane: along the surface a point has no
// counterpart of its own, only one within half a spacing.
constexpr double kPointWeight = 0.1;

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

float reach_m(const PreparedModel& model, int iteration) {
  return std::max(kSameDistance, 4.0F - static_cast<float>(iteration) * 0.4F) * model.spacing_m;
}

struct Match {
  std::size_t model_point;
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
    matches.push_back({static_cast<std::size_t>(nearest), &q, &seen, p});
  }
  return matches;
}

void keep_colors(std::vector<Match>& matches, LitModel& lit) {
  std::erase_if(matches, [&lit](const Match& match) {
    return !lit.same_color(match.model_point, *match.seen);
  });
}

/// [v]x: its product with another vector is v x that.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

/// The small motion of the points seen, in O, that brings them onto the model.
Vector6d step_O(const std::vector<Match>& matches) {
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (const Match& match : matches) {
    const Eigen::Vector3d p = match.seen_O.cast<double>();
    const Eigen::Vector3d difference = match.model->position.cast<double>() - p;
    const Eigen::Vector3d n = match.model->normal.cast<double>();
    Vector6d J;
    J << n, p.cross(n);
    H.noalias() += J * J.transpose();
    b += J * n.dot(difference);
    // To the point: the rows of J are those of (I, -[p]x).
    b.head<3>() += kPointWeight * difference;
    b.tail<3>() += kPointWeight * p.cross(difference);
    sum += p;
    products.noalias() += p * p.transpose();
  }
  const Eigen::Matrix3d sum_x = cross_matrix(kPointWeight * sum);
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  H.topLeftCorner<3, 3>() += kPointWeight * static_cast<double>(matches.size()) * identity;
  H.topRightCorner<3, 3>() -= sum_x;
  H.bottomLeftCorner<3, 3>() += sum_x;
  H.bottomRightCorner<3, 3>() += kPointWeight * (products.trace() * identity - products);
  H.diagonal().array() += 1e-9;
  return H.ldlt().solve(b);
}

Pose motion_of(const Vector6d& step) {
  Pose motion = Pose::Identity();
  const double angle = step.tail<3>().norm();
  if (angle > 0.0) {
    motion.linear() = Eigen::AngleAxisd(angle, step.tail<3>() / angle).toRotationMatrix();
  }
  motion.translation() = step.head<3>();
  return motion;
}

/// Iterations `first` to before `last`. Beyond the first matches, light is that of these.
PoseHypothesis refined(const PreparedModel& model, const Surface& seen_W, const Pose& X_WO,
                       int first, int last) {
  constexpr std::size_t kFewest = 6;  // what six unknowns take
  Pose X_OW = X_WO.inverse();
  std::vector<Match> matches = matches_of(model, seen_W, X_OW, reach_m(model, first));
  LitModel lit(model.surface_O, light_change(matches));
  for (int i = first; i < last; ++i) {
    if (i > first) matches = matches_of(model, seen_W, X_OW, reach_m(model, i));
    keep_colors(matches, lit);
    if (matches.size() < kFewest) break;
    const Vector6d step = step_O(matches);
    X_OW = motion_of(step) * X_OW;
    const bool is_shortest = reach_m(model, i) <= reach_m(model, kIterations);
    const double moved_m = step.head<3>().norm() + step.tail<3>().norm() * model.radius_m;
    if (is_shortest && moved_m < 1e-4) break;
  }
  X_OW.linear() = Eigen::Quaterniond(X_OW.linear()).normalized().toRotationMatrix();
  PoseHypothesis result;
  result.X_WO = X_OW.inverse();
  matches = matches_of(model, seen_W, X_OW, reach_m(model, last));
  result.light = light_change(matches);
  LitModel lit_at_last(model.surface_O, result.light);
  keep_colors(matches, lit_at_last);
  result.agreement = seen_W.empty()
                         ? 0.0F
                         : static_cast<float>(matches.size()) / static_cast<float>(seen_W.size());
  return result;
}

}  // namespace

PoseHypothesis refined_pose(const PreparedModel& model, const Surface& seen_W, const Pose& X_WO) {
  return refined(model, seen_W, X_WO, 0, kIterations);
}

PoseHypothesis roughly_refined_pose(const PreparedModel& model, const Surface& seen_W,
                                    const Pose& X_WO) {
  return refined(model, seen_W, X_WO, 0, kRoughIterations);
}

PoseHypothesis finely_refined_pose(const PreparedModel& model, const Surface& seen_W,
                                   const Pose& X_WO) {
  return refined(model, seen_W, X_WO, kRoughIterations, kIterations);
}

}  // namespace kintsugi::segmenter
