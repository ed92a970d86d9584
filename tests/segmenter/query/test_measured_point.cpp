// What a camera measures at a pixel.

#include <stdexcept>

#include <gtest/gtest.h>

#include "segmenter/query/measured_point.hpp"
#include "tests/segmenter/query/camera_view.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::blind_view;
using testing::depth_mm;
using testing::view_of_wall;

Pose example_X_WC() {
  Pose X_WC = Pose::Identity();
  X_WC.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  X_WC.translation() << 1.0, -2.0, 0.5;
  return X_WC;
}

TEST(MeasuredPoint, IsThePointWhoseDepthWasMeasured) {
  const Pose X_WC = example_X_WC();
  CameraView view = blind_view(3, X_WC);
  depth_mm(view, 20, 70) = 1'500;  // of the pixel (82, 282)
  const Eigen::Vector3d p_C(1.5 * (82 - 319.5) / 525, 1.5 * (282 - 239.5) / 525, 1.5);
  for (const double off_px : {-1.9, 0.0, 1.9}) {
    const auto measured = measured_point(view, 82 + off_px, 282 - off_px);
    ASSERT_TRUE(measured);
    EXPECT_TRUE(measured->point_W().isApprox(X_WC * p_C, 1e-12));
    EXPECT_NEAR(measured->distance_m, p_C.norm(), 1e-12);
    EXPECT_EQ(measured->ray.origin_W, X_WC.translation());
  }
}

TEST(MeasuredPoint, WhatIsMeasuredBesideDoesNotStandInForWhatIsNot) {
  CameraView view = view_of_wall(3, Pose::Identity(), 2.0);
  depth_mm(view, 20, 70) = 0;
  EXPECT_FALSE(measured_point(view, 82, 282));
  EXPECT_TRUE(measured_point(view, 86, 282));
  EXPECT_TRUE(measured_point(view, 82, 278));
}

TEST(MeasuredPoint, EveryPixelOfTheImageHasASampleAndNoOther) {
  const CameraView view = view_of_wall(3, Pose::Identity(), 2.0);
  for (const double u_px : {-0.5, 0.0, 639.0, 639.5}) {
    for (const double v_px : {-0.5, 0.0, 479.0, 479.5}) {
      const auto measured = measured_point(view, u_px, v_px);
      ASSERT_TRUE(measured);
      EXPECT_NEAR(measured->point_W().z(), 2.0, 1e-12);
    }
  }
  EXPECT_THROW(measured_point(view, 640.0, 0.0), std::invalid_argument);
  EXPECT_THROW(measured_point(view, 0.0, -1.0), std::invalid_argument);
}

TEST(MeasuredPoint, AnImageThatIsNoMultipleOfTheStepHasNoSampleInItsRest) {
  CameraView view = blind_view(3, Pose::Identity());
  view.intrinsics.width = 643;  // 160 samples, the last one at pixel 638
  depth_mm(view, 159, 0) = 1'000;
  ASSERT_TRUE(measured_point(view, 642, 0));
  EXPECT_NEAR(measured_point(view, 642, 0)->point_W().x(), (638 - 319.5) / 525, 1e-12);
}

TEST(MeasuredPoint, ReachesAtLeastThreeCentimetres) {
  EXPECT_EQ(pixel_radius_m(0.005), 0.03);
  EXPECT_EQ(pixel_radius_m(0.04), 0.08);
}

}  // namespace
}  // namespace kintsugi::segmenter
