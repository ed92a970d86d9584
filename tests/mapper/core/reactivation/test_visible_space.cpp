#include <limits>

#include <gtest/gtest.h>

#include "mapper/core/reactivation/visible_space.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kMargin_m = 0.05;
constexpr double kRadius_m = 0.1;

const Intrinsics kCamera{.fx = 160, .fy = 160, .cx = 79.5, .cy = 59.5, .width = 160, .height = 120};

/// A wall 2 m before the camera; the right half of the image is invalid.
class HalfAWall : public ::testing::Test {
 protected:
  HalfAWall() {
    depth_m_.colRange(80, 160).setTo(std::numeric_limits<float>::quiet_NaN());
    X_UC_.translation() = Eigen::Vector3d(5, 6, 7);
  }
  bool meets(double x, double y, double z) const {
    return VisibleSpace(depth_m_, kCamera, X_UC_, kMargin_m)
        .meets(X_UC_ * Eigen::Vector3d(x, y, z), kRadius_m);
  }

  cv::Mat_<float> depth_m_ = cv::Mat_<float>(120, 160, 2.0F);
  Pose X_UC_ = Pose::Identity();
};

TEST_F(HalfAWall, IsMetByWhatIsOnItOrBeforeIt) {
  EXPECT_TRUE(meets(-0.5, 0, 2.0));
  EXPECT_TRUE(meets(-0.3, 0, 1.0)) << "the camera looks through it";
  EXPECT_TRUE(meets(-0.5, 0, 2.0 + kMargin_m + 0.9 * kRadius_m));
  EXPECT_FALSE(meets(-0.5, 0, 2.0 + kMargin_m + 1.1 * kRadius_m)) << "hidden";
}

TEST_F(HalfAWall, IsNotMetOutsideTheImageOrWhereNothingWasMeasured) {
  EXPECT_FALSE(meets(0.7, 0, 2.0)) << "invalid";
  EXPECT_FALSE(meets(-1.5, 0, 2.0)) << "left of the image";
  EXPECT_TRUE(meets(-1.05, 0, 2.0)) << "part of it is in the image";
  EXPECT_FALSE(meets(-0.5, 1.5, 2.0)) << "below";
  EXPECT_FALSE(meets(-0.2, 0, -1.0)) << "behind the camera";
}

TEST_F(HalfAWall, IsMetByWhatIsAroundTheCamera) { EXPECT_TRUE(meets(-0.02, 0, 0.02)); }

}  // namespace
}  // namespace kintsugi::mapper
