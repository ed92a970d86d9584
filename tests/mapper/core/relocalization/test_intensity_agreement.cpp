#include <cmath>

#include <gtest/gtest.h>

#include "mapper/core/relocalization/intensity_agreement.hpp"

namespace kintsugi::mapper {
namespace {

Intrinsics camera() { return {100.0, 100.0, 79.5, 59.5, 160, 120, {}}; }

/// A wall 2 m ahead.
SurfaceMap wall() {
  SurfaceMap surface(camera());
  surface.depth_m.setTo(2.0F);
  return surface;
}

/// Waves on the wall as seen by a camera that stands x_m to the right.
cv::Mat_<std::uint8_t> waves(double x_m, double contrast = 50.0, double level = 100.0) {
  cv::Mat_<std::uint8_t> intensity(camera().height, camera().width);
  for (int v = 0; v < intensity.rows; ++v) {
    for (int u = 0; u < intensity.cols; ++u) {
      const double x_W = x_m + 2.0 * (u - camera().cx) / camera().fx;
      const double y_W = 2.0 * (v - camera().cy) / camera().fy;
      intensity(v, u) = cv::saturate_cast<std::uint8_t>(level + contrast * std::sin(5.0 * x_W) *
                                                                    std::cos(4.0 * y_W));
    }
  }
  return intensity;
}

Pose to_the_right(double x_m) {
  Pose X = Pose::Identity();
  X.translation().x() = x_m;
  return X;
}

TEST(IntensityAgreement, IsOneForTheSameThingWhateverTheExposure) {
  const auto agreement =
      intensity_agreement(wall(), waves(0.3, 20.0, 60.0), wall(), waves(0.0), to_the_right(0.3));
  ASSERT_TRUE(agreement);
  EXPECT_GT(*agreement, 0.98);  // nearest pixels and whole levels of 20
}

TEST(IntensityAgreement, IsLowAtAWrongPose) {
  // Half a wave off: pi / 5 m.
  const auto agreement =
      intensity_agreement(wall(), waves(0.3), wall(), waves(0.0), to_the_right(0.3 + 0.628));
  ASSERT_TRUE(agreement);
  EXPECT_LT(*agreement, -0.9);
}

TEST(IntensityAgreement, SaysNothingWithoutTextureOrOverlap) {
  EXPECT_FALSE(intensity_agreement(wall(), waves(0.0, 2.0), wall(), waves(0.0), to_the_right(0)));
  EXPECT_FALSE(intensity_agreement(wall(), waves(3.0), wall(), waves(0.0), to_the_right(3.0)));
}

TEST(IntensityAgreement, LeavesOutWhatIsHidden) {
  SurfaceMap screen = wall();
  screen.depth_m(cv::Rect(0, 0, 80, 120)).setTo(1.0F);
  cv::Mat_<std::uint8_t> covered = waves(0.0);
  covered(cv::Rect(0, 0, 80, 120)).setTo(0);
  const auto agreement = intensity_agreement(wall(), waves(0.0), screen, covered, Pose::Identity());
  ASSERT_TRUE(agreement);
  EXPECT_NEAR(*agreement, 1.0, 1e-9);
}

}  // namespace
}  // namespace kintsugi::mapper
