#include "mapper/core/trajectory_error.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kintsugi::mapper {

TrajectoryError absolute_trajectory_error(const Trajectory& estimate, const Trajectory& truth) {
  std::vector<Eigen::Vector3d> estimated;
  std::vector<Eigen::Vector3d> actual;
  for (const StampedPose& pose : estimate) {
    if (const auto X_WC = pose_at(truth, pose.utime)) {
      estimated.emplace_back(pose.X_WC.translation());
      actual.emplace_back(X_WC->translation());
    }
  }
  if (estimated.size() < 3) {
    throw std::invalid_argument("trajectory error: " + std::to_string(estimated.size()) +
                                " poses have a true pose within 20 ms, expected at least 3");
  }
  const auto count = static_cast<Eigen::Index>(estimated.size());
  const Eigen::Map<const Eigen::Matrix3Xd> from(estimated.front().data(), 3, count);
  const Eigen::Map<const Eigen::Matrix3Xd> to(actual.front().data(), 3, count);
  const Pose alignment(Eigen::umeyama(from, to, false));

  std::vector<double> errors_m;
  double squares = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    errors_m.push_back((alignment * from.col(i) - to.col(i)).norm());
    squares += errors_m.back() * errors_m.back();
  }
  std::sort(errors_m.begin(), errors_m.end());
  return {static_cast<int>(count), std::sqrt(squares / static_cast<double>(count)),
          errors_m[errors_m.size() / 2], errors_m.back()};
}

}  // namespace kintsugi::mapper
