#include <gtest/gtest.h>

#include "mapper/core/loop_closure/camera_path.hpp"

namespace kintsugi::mapper {
namespace {

Pose at(double x, double y = 0.0) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(x, y, 0.0);
  return pose;
}

/// Ten frames along x, 0.1 m apart; at keyframe 0 and, from frame 5 on, at keyframe 1.
CameraPath two_stays(bool jumped) {
  CameraPath path;
  for (int i = 0; i < 10; ++i)
    path.add(std::int64_t{1000} * i, at(0.1 * i), i < 5 ? 0 : 1, jumped && i == 5);
  return path;
}

MapDeformation up_at_keyframe_1(int part = 0) { return {1, {{at(0.0), 0}, {at(0.0, 0.5), part}}}; }

TEST(CameraPath, StaysAsTrackedWithoutACorrection) {
  const Trajectory path = two_stays(false).corrected(MapDeformation()).at(0);
  ASSERT_EQ(path.size(), 10U);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(path[i].utime, 1000 * i);
    EXPECT_TRUE(path[i].X_WC.isApprox(at(0.1 * i), 1e-12));
  }
}

TEST(CameraPath, KeepsPosesFarFromTheOrigin) {
  Pose tilted = at(1e4, -2e4);
  tilted.linear() = Eigen::AngleAxisd(2.5, Eigen::Vector3d(1.0, 2.0, -3.0).normalized()).matrix();
  CameraPath path;
  path.add(7, tilted, 0, false);
  const Pose error = path.corrected(MapDeformation()).at(0).at(0).X_WC.inverse() * tilted;
  EXPECT_LT(error.translation().norm(), 1e-9);
  EXPECT_LT(rotation_angle_rad(error), 1e-6);
}

TEST(CameraPath, GoesOverFromOneCorrectionToTheNextLinearly) {
  const Trajectory path = two_stays(false).corrected(up_at_keyframe_1()).at(0);
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(path[i].X_WC.translation().y(), i < 5 ? 0.1 * i : 0.5, 1e-12) << "frame " << i;
  }
}

TEST(CameraPath, JumpsWhereTheCameraDid) {
  const CameraPath jump = two_stays(true);
  const Trajectory path = jump.corrected(up_at_keyframe_1()).at(0);
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(path[i].X_WC.translation().y(), i < 5 ? 0.0 : 0.5, 1e-12) << "frame " << i;
  }
  EXPECT_NEAR(two_stays(false).length_m(), 0.9, 1e-12);
  EXPECT_NEAR(jump.length_m(), 0.8, 1e-12) << "without the jump";
}

TEST(CameraPath, IsInPartsUntilTheyAreJoined) {
  const CameraPath path = two_stays(true);
  const std::map<int, Trajectory> apart = path.corrected(up_at_keyframe_1(1));
  ASSERT_EQ(apart.size(), 2U);
  EXPECT_EQ(apart.at(0).size(), 5U);
  EXPECT_EQ(apart.at(1).size(), 5U);
  EXPECT_EQ(apart.at(1).front().utime, 5'000);
  const std::map<int, Trajectory> joined = path.corrected(up_at_keyframe_1(0));
  ASSERT_EQ(joined.size(), 1U);
  EXPECT_EQ(joined.at(0).size(), 10U);
}

}  // namespace
}  // namespace kintsugi::mapper
