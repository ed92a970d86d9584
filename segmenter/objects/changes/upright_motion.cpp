#include "segmenter/objects/changes/upright_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr int kIterations = 30;
constexpr double kShrink = 0.85;  // of the reach, in each iteration
constexpr double kLeastReach_vox = 2.0;
constexpr float kAlike = 0.7F;        // cosine between normals: 45 degrees
constexpr int kNeighbours = 4;        // of two faces of an edge, some are on each
constexpr std::size_t kMost = 1'500;  // points of a side that are matched
constexpr int kLeastMatches = 12;
// Of a residual along the surface beside one across: there a point has no counterpart of its own,
// only one within half a voxel. It decides only where nothing else holds the thing.
constexpr double kAlong = 0.02;
constexpr double kSettled = 1e-5;

using Vector4 = Eigen::Matrix<double, 4, 1>;
using Matrix4 = Eigen::Matrix<double, 4, 4>;

/// The turn about `up` that is nearest to the rotation.
Eigen::Matrix3d upright(const Eigen::Matrix3d& R, const Eigen::Vector3d& up) {
  const Eigen::Quaterniond q(R);
  const double angle = 2.0 * std::atan2(q.vec().dot(up), q.w());
  return Eigen::AngleAxisd(angle, up).toRotationMatrix();
}

std::vector<CloudPoint> some_of(std::span<const CloudPoint> points) {
  const std::size_t count = std::min(points.size(), kMost);
  std::vector<CloudPoint> some;
  some.reserve(count);
  for (std::size_t i = 0; i < count; ++i) some.push_back(points[i * points.size() / count]);
  return some;
}

struct System {
  Matrix4 A = Matrix4::Zero();
  Vector4 b = Vector4::Zero();
  int num_matches = 0;

  /// @param p is to be moved to `target`, whose normal is n
  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& target, const Eigen::Vector3d& n,
           const Eigen::Vector3d& center, const Eigen::Vector3d& up, double reach_m) {
    const Eigen::Vector3d difference = target - p;
    const double share = difference.norm() / reach_m;
    const double tukey = (1.0 - share * share) * (1.0 - share * share);
    const Eigen::Vector3d turned = up.cross(p - center);
    const auto add_row = [&](const Eigen::Vector3d& axis, double weight) {
      Vector4 J;
      J << axis, axis.dot(turned);
      A += weight * J * J.transpose();
      b += weight * axis.dot(difference) * J;
    };
    add_row(n, tukey);
    for (int k = 0; k < 3; ++k) add_row(Eigen::Vector3d::Unit(k), kAlong * tukey);
    ++num_matches;
  }
};

/// The nearest of each that faces the same way, within reach; visits (query, target).
template <class Visit>
void match(const std::vector<CloudPoint>& queries, std::span<const CloudPoint> points,
           const NearestNeighbours& tree, double reach_m, const Visit& visit) {
  NearestNeighbours::Result result;
  tree.find(queries, kNeighbours, result);
  const auto count = static_cast<std::size_t>(result.count);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      if (result.squared_distances[i * count + k] > reach_m * reach_m) break;
      const CloudPoint& there = points[result.indices[i * count + k]];
      if (normal_of(queries[i]).dot(normal_of(there)) < kAlike) continue;
      visit(i, there);
      break;
    }
  }
}

}  // namespace

Pose refined_motion(std::span<const CloudPoint> before, std::span<const CloudPoint> after,
                    const Pose& X_after_before, const Eigen::Vector3d& up, double voxel_m,
                    double reach_m) {
  const std::vector<CloudPoint> some_before = some_of(before);
  const std::vector<CloudPoint> some_after = some_of(after);
  const NearestNeighbours tree_before(before);
  const NearestNeighbours tree_after(after);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const CloudPoint& p : some_before) center += position_of(p).cast<double>();
  center /= static_cast<double>(some_before.size());
  Pose X = X_after_before;
  X.linear() = upright(X_after_before.linear(), up);
  X.translation() = X_after_before * center - X.linear() * center;
  for (int i = 0; i < kIterations; ++i) {
    const double reach = std::max(kLeastReach_vox * voxel_m, reach_m * std::pow(kShrink, i));
    const Pose X_inverse = X.inverse(Eigen::Isometry);
    const Eigen::Vector3d center_now = X * center;
    const std::vector<CloudPoint> moved = transformed(X, some_before);
    System system;
    match(moved, after, tree_after, reach, [&](std::size_t k, const CloudPoint& there) {
      system.add(position_of(moved[k]).cast<double>(), position_of(there).cast<double>(),
                 normal_of(there).cast<double>(), center_now, up, reach);
    });
    match(transformed(X_inverse, some_after), before, tree_before, reach,
          [&](std::size_t k, const CloudPoint& there) {
            system.add(X * position_of(there).cast<double>(),
                       position_of(some_after[k]).cast<double>(),
                       normal_of(some_after[k]).cast<double>(), center_now, up, reach);
          });
    if (system.num_matches < kLeastMatches) break;
    const Vector4 step = (system.A + 1e-9 * Matrix4::Identity()).ldlt().solve(system.b);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(step[3], up).toRotationMatrix();
    Pose motion = Pose::Identity();
    motion.linear() = turn;
    motion.translation() = center_now + step.head<3>() - turn * center_now;
    X = motion * X;
    X.linear() = upright(X.linear(), up);
    if (reach <= kLeastReach_vox * voxel_m && step.norm() < kSettled) break;
  }
  return X;
}

}  // namespace kintsugi::segmenter
