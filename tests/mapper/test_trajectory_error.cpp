#include <cmath>

#include <gtest/gtest.h>

#include "mapper/core/trajectory_error.hpp"

namespace kintsugi::mapper {
namespace {

Trajectory helix(int poses) {
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i) {
    StampedPose pose{std::int64_t{i} * 33333, Pose::Identity()};
    pose.X_WC.translation() << std::cos(0.1 * i), std::sin(0.1 * i), 0.02 * i;
    trajectory.push_back(pose);
  }
  return trajectory;
}

TEST(AbsoluteTrajectoryError, IgnoresTheChoiceOfFrame) {
  const Trajectory truth = helix(60);
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  X.translation() << 4, -5, 6;
  Trajectory moved = truth;
  for (StampedPose& pose : moved) pose.X_WC = X * pose.X_WC;
  const TrajectoryError error = absolute_trajectory_error(moved, truth);
  EXPECT_EQ(error.pairs, 60);
  EXPECT_LT(error.max_m, 1e-9);
}

TEST(AbsoluteTrajectoryError, DoesNotForgiveScale) {
  const Trajectory truth = helix(60);
  Trajectory grown = truth;
  for (StampedPose& pose : grown) pose.X_WC.translation() *= 1.1;
  // What is left is 10 % of the distance of each pose from the mean of all.
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : truth) mean += pose.X_WC.translation() / 60.0;
  double squares = 0.0;
  for (const StampedPose& pose : truth) {
    squares += (0.1 * (pose.X_WC.translation() - mean)).squaredNorm();
  }
  EXPECT_NEAR(absolute_trajectory_error(grown, truth).rmse_m, std::sqrt(squares / 60.0), 1e-9);
}

TEST(AbsoluteTrajectoryError, SkipsPosesWithoutATrueOneAndNeedsThree) {
  const Trajectory truth = helix(60);
  Trajectory few(truth.begin(), truth.begin() + 2);
  EXPECT_THROW(absolute_trajectory_error(few, truth), std::invalid_argument);
  few.push_back(truth[40]);
  few.push_back({truth.back().utime + 1'000'000, Pose::Identity()});
  EXPECT_EQ(absolute_trajectory_error(few, truth).pairs, 3);
}

}  // namespace
}  // namespace kintsugi::mapper
