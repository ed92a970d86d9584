#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/trajectory.hpp"

namespace kintsugi {
namespace {

using ::testing::HasSubstr;

Trajectory read(const std::string& text) {
  std::istringstream in(text);
  return read_tum(in, "path.txt");
}

std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

StampedPose at_x(std::int64_t utime, double x, double angle_rad = 0.0) {
  StampedPose pose{utime, Pose::Identity()};
  pose.X_WC.translation().x() = x;
  pose.X_WC.linear() = Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

TEST(ParseSeconds, IsExactToTheMicrosecond) {
  // A double times 1e6 would have an error of up to 0.1 us, and could be truncated.
  EXPECT_EQ(parse_seconds_us("1341836537.655691"), 1341836537655691);
  EXPECT_EQ(parse_seconds_us("0.1"), 100000);
  EXPECT_EQ(parse_seconds_us("12"), 12000000);
  EXPECT_EQ(parse_seconds_us("12."), 12000000);
  EXPECT_EQ(parse_seconds_us("0.0333333333"), 33333);
  EXPECT_EQ(parse_seconds_us("0.9999999"), 1000000);
  EXPECT_EQ(parse_seconds_us("-1.5"), -1500000);
}

TEST(ParseSeconds, RefusesTextsThatAreNoDecimalNumber) {
  for (const char* text :
       {"", ".", ".5", "-", "nan", "1e9", "1.2.3", "0x10", "1.5s", "+1", "99999999999999999999"}) {
    EXPECT_EQ(parse_seconds_us(text), std::nullopt) << text;
  }
}

TEST(ReadTum, IgnoresCommentsAndBlankLines) {
  const Trajectory trajectory = read(
      "# a comment\n\n"
      "1.5 1 2 3 0 0 0 1\n"
      "  2.5\t4 5 6 0 0 0.7071 0.7071 # with few decimals\r\n");
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory[0].utime, 1500000);
  EXPECT_TRUE(trajectory[0].X_WC.translation().isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_LT(
      (trajectory[1].X_WC.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(),
      1e-12);
}

TEST(ReadTum, ErrorsNameFileLineAndReason) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  EXPECT_THAT(error_of(good + "2 0 0 0 0 0 1\n"), HasSubstr("path.txt:2: 7 fields, expected 8"));
  EXPECT_THAT(error_of(good + "2 0 0 0 0 0 0 1 9\n"), HasSubstr("path.txt:2: 9 fields"));
  EXPECT_THAT(error_of("x 0 0 0 0 0 0 1\n"), HasSubstr("path.txt:1: timestamp 'x'"));
  EXPECT_THAT(error_of("1 0 nan 0 0 0 0 1\n"), HasSubstr("field 3 'nan' is no finite number"));
  EXPECT_THAT(error_of("1 0 0 inf 0 0 0 1\n"), HasSubstr("field 4 'inf'"));
  EXPECT_THAT(error_of("1 0 0 1e999 0 0 0 1\n"), HasSubstr("field 4"));
  EXPECT_THAT(error_of("1 0 0 1,5 0 0 0 1\n"), HasSubstr("field 4 '1,5'"));
  EXPECT_THAT(error_of("1 0 0 0 0 0 0 0\n"), HasSubstr("quaternion has length 0.0"));
  EXPECT_THAT(error_of("1 0 0 0 1 0 0 1\n"), HasSubstr("quaternion has length 1.41"));
  EXPECT_THAT(error_of(good + good), HasSubstr("path.txt:2: timestamp 1 is not after"));
  EXPECT_THAT(error_of("# nothing\n"), HasSubstr("path.txt: holds no pose"));
}

TEST(WriteTum, CanBeReadBack) {
  Trajectory trajectory = {at_x(1341836537655691, 0.123456789, 0.5), at_x(1341836537655692, -7)};
  std::ostringstream out;
  write_tum(out, trajectory);
  EXPECT_THAT(out.str(), HasSubstr("\n1341836537.655691 0.123456789 "));
  const Trajectory again = read(out.str());
  ASSERT_EQ(again.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again[i].utime, trajectory[i].utime);
    // Nine decimals are written.
    EXPECT_LT((again[i].X_WC.matrix() - trajectory[i].X_WC.matrix()).norm(), 1e-8);
  }
}

TEST(PoseAt, InterpolatesBetweenNearPoses) {
  const Trajectory trajectory = {at_x(0, 0.0, 0.0), at_x(10000, 1.0, 0.4), at_x(100000, 2.0)};
  const auto pose = pose_at(trajectory, 2500);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->translation().x(), 0.25, 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd(pose->linear()).angle(), 0.1, 1e-12);
}

TEST(PoseAt, UsesTheOnlyNearPoseOrNone) {
  const Trajectory trajectory = {at_x(0, 0.0), at_x(100000, 1.0)};
  EXPECT_DOUBLE_EQ(pose_at(trajectory, 0)->translation().x(), 0.0);
  EXPECT_DOUBLE_EQ(pose_at(trajectory, 20000)->translation().x(), 0.0);
  EXPECT_DOUBLE_EQ(pose_at(trajectory, 80000)->translation().x(), 1.0);
  EXPECT_DOUBLE_EQ(pose_at(trajectory, -20000)->translation().x(), 0.0);
  EXPECT_DOUBLE_EQ(pose_at(trajectory, 120000)->translation().x(), 1.0);
  EXPECT_FALSE(pose_at(trajectory, 20001));
  EXPECT_FALSE(pose_at(trajectory, 120001));
  EXPECT_FALSE(pose_at({}, 0));
}

}  // namespace
}  // namespace kintsugi
