#include <cmath>

#include <gtest/gtest.h>

#include "mapper/core/surface_pyramid.hpp"
#include "tests/mapper/box_room.hpp"

namespace kintsugi::mapper {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(HalfSizeCamera, SeesTheMiddleOfFourPixelsAsOne) {
  const Intrinsics full{500, 480, 320.25, 239.5, 641, 480, {}};
  const Intrinsics half = half_size(full);
  EXPECT_EQ(half.width, 320);
  EXPECT_EQ(half.height, 240);
  // The ray of half pixel (u, v) is that of the full image's (2u + 1/2, 2v + 1/2).
  EXPECT_DOUBLE_EQ((7 - half.cx) / half.fx, (14.5 - full.cx) / full.fx);
  EXPECT_DOUBLE_EQ((9 - half.cy) / half.fy, (18.5 - full.cy) / full.fy);
}

TEST(HalfSizeDepth, AveragesOneSurfaceAndKeepsTheNearerOfTwo) {
  cv::Mat_<float> depth(2, 8);
  depth << 1.00F, 1.02F, 1.0F, 3.0F, kNaN, 2.0F, kNaN, kNaN,  //
      1.00F, 1.02F, 3.0F, 3.0F, 2.02F, kNaN, kNaN, kNaN;
  const cv::Mat_<float> half = half_size(depth);
  ASSERT_EQ(half.size(), cv::Size(4, 1));
  EXPECT_FLOAT_EQ(half(0, 0), 1.01F);
  EXPECT_FLOAT_EQ(half(0, 1), 1.0F);   // not 2.5: there is nothing there
  EXPECT_FLOAT_EQ(half(0, 2), 2.01F);  // of the valid ones
  EXPECT_TRUE(std::isnan(half(0, 3)));
}

TEST(SurfaceFromDepth, GivesThePointsAndNormalsOfAnExactRoom) {
  const Intrinsics camera = testing::test_camera();
  const SurfaceMap truth = testing::render_room(testing::looking_at_the_crate(), camera);
  const SurfaceMap surface = surface_from_depth(truth.depth_m, camera);
  int with_normal = 0;
  int wrong = 0;
  for (int v = 1; v + 1 < camera.height; ++v) {
    for (int u = 1; u + 1 < camera.width; ++u) {
      EXPECT_LT((surface.point(v, u) - truth.point(v, u)).norm(), 1e-5);
      if (std::isnan(surface.normal_x(v, u))) continue;
      ++with_normal;
      if (surface.normal(v, u).dot(truth.normal(v, u)) < 0.999F) ++wrong;
    }
  }
  // Wrong only beside the creases of the boxes, a few lines of pixels of a 320x240 image.
  EXPECT_GT(with_normal, 0.97 * camera.width * camera.height);
  EXPECT_LT(wrong, 0.03 * with_normal);
}

TEST(SurfaceFromDepth, HasNoNormalBesideAHoleOrAStep) {
  const Intrinsics camera = testing::test_camera(16, 12);
  cv::Mat_<float> depth(12, 16, 2.0F);
  depth(5, 5) = kNaN;
  depth.colRange(10, 16).setTo(2.5F);
  const SurfaceMap surface = surface_from_depth(depth, camera);
  EXPECT_TRUE(std::isnan(surface.depth_m(5, 5)));
  EXPECT_TRUE(std::isnan(surface.normal_x(5, 5)));
  EXPECT_TRUE(std::isnan(surface.normal_z(5, 4)));
  EXPECT_TRUE(std::isnan(surface.normal_z(6, 5)));
  EXPECT_TRUE(std::isnan(surface.normal_z(5, 9)));
  EXPECT_TRUE(std::isnan(surface.normal_z(0, 3)));  // border
  EXPECT_LT((surface.normal(3, 3) - Eigen::Vector3f(0, 0, -1)).norm(), 1e-6);
}

TEST(SurfaceFromDepth, RefusesAnImageOfAnotherSize) {
  EXPECT_THROW(surface_from_depth(cv::Mat_<float>(10, 10, 1.0F), testing::test_camera()),
               std::invalid_argument);
}

TEST(PyramidFromDepth, StartsAfterTheSkippedSizesAndCutsFarDepth) {
  cv::Mat_<float> depth(64, 96, 2.0F);
  depth.rowRange(0, 32).setTo(5.0F);
  const SurfacePyramid pyramid =
      pyramid_from_depth(depth, testing::test_camera(96, 64), 1, 3, 4.0F);
  ASSERT_EQ(pyramid.size(), 3U);
  EXPECT_EQ(pyramid[0].depth_m.size(), cv::Size(48, 32));
  EXPECT_EQ(pyramid[2].depth_m.size(), cv::Size(12, 8));
  EXPECT_TRUE(std::isnan(pyramid[0].depth_m(3, 3)));
  EXPECT_FLOAT_EQ(pyramid[0].depth_m(20, 3), 2.0F);
  EXPECT_FLOAT_EQ(depth(0, 0), 5.0F);  // the caller's image is not touched
}

TEST(PyramidFromSurface, KeepsPlanesOnTheirPlane) {
  const Intrinsics camera = testing::test_camera(64, 48);
  const SurfacePyramid pyramid =
      pyramid_from_surface(surface_from_depth(cv::Mat_<float>(48, 64, 1.5F), camera), 3);
  ASSERT_EQ(pyramid.size(), 3U);
  EXPECT_EQ(pyramid[2].intrinsics.width, 16);
  const Eigen::Vector3f point = pyramid[2].point(5, 5);
  const Intrinsics& coarse = pyramid[2].intrinsics;
  EXPECT_NEAR(point[0], 1.5 * (5 - coarse.cx) / coarse.fx, 1e-5);
  EXPECT_FLOAT_EQ(point[2], 1.5F);
  EXPECT_LT((pyramid[2].normal(5, 5) - Eigen::Vector3f(0, 0, -1)).norm(), 1e-6);
}

}  // namespace
}  // namespace kintsugi::mapper
