#pragma once
// Camera paths for tests of trajectory errors.

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "lcmtypes/trajectory.hpp"

namespace kintsugi::testing {

/// A pose every 33,333 us, each 10 cm further and turned by 0.1 rad about z.
inline Trajectory helix(int poses) {
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i) {
    StampedPose pose{std::int64_t{i} * 33'333, Pose::Identity()};
    pose.X_WC.linear() = Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.X_WC.translation() << std::cos(0.1 * i), std::sin(0.1 * i), 0.02 * i;
    trajectory.push_back(pose);
  }
  return trajectory;
}

inline Trajectory moved(const Pose& X_BA, Trajectory path_A) {
  for (StampedPose& pose : path_A) pose.X_WC = X_BA * pose.X_WC;
  return path_A;
}

/// Uniform in [-1, 1].
inline double random_number(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0;
}

inline Eigen::Vector3d random_vector(std::mt19937_64& random) {
  const double x = random_number(random);
  const double y = random_number(random);
  return {x, y, random_number(random)};
}

/// A random pose: moved by up to `reach_m` along each axis, turned by up to `reach_rad` about each.
inline Pose random_pose(std::mt19937_64& random, double reach_m = 5.0, double reach_rad = 1.5) {
  const Eigen::Vector3d turn = reach_rad * random_vector(random);
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  X.translation() = reach_m * random_vector(random);
  return X;
}

}  // namespace kintsugi::testing
