#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "mapper/core/frame/covered_share.hpp"
#include "mapper/core/frame/kernel_arguments.hpp"
#include "mapper/core/frame/surface_pyramid.hpp"
#include "mapper/core/kernels/instruction_set.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A part of the image of test_camera(): its pixels are as wide.
Intrinsics cut_out(int width, int height) {
  Intrinsics camera = testing::test_camera();
  camera.cx = 0.5 * width - 0.5;
  camera.cy = 0.5 * height - 0.5;
  camera.width = width;
  camera.height = height;
  return camera;
}

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
  const cv::Mat_<float> half =
      half_size(depth, depth_tolerance(DepthNoise(), testing::test_camera()));
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
  const Intrinsics camera = cut_out(16, 12);
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

TEST(PyramidFromSurface, AveragesWhatLiesWithTheNearest) {
  SurfaceMap fine(cut_out(4, 2));
  fine.depth_m << 2.0F, 2.02F, kNaN, kNaN,  //
      3.0F, 2.04F, kNaN, kNaN;
  for (int i = 0; i < 8; ++i) fine.set_normal(i / 4, i % 4, {0, 0, -1});
  fine.set_normal(0, 1, Eigen::Vector3f(0, 0.6F, -0.8F));
  fine.set_normal(1, 1, Eigen::Vector3f::Constant(kNaN));  // takes no part
  fine.set_normal(1, 0, {1, 0, 0});                        // another surface
  const SurfaceMap half = pyramid_from_surface(fine, 2)[1];
  EXPECT_FLOAT_EQ(half.depth_m(0, 0), 2.01F);
  EXPECT_LT((half.normal(0, 0) - Eigen::Vector3f(0, 0.6F, -1.8F).normalized()).norm(), 1e-6F);
  EXPECT_TRUE(std::isnan(half.depth_m(0, 1)));
  EXPECT_TRUE(std::isnan(half.normal_x(0, 1)));
}

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

TEST(Pyramids, GiveTheSameBytesWithEveryInstructionSet) {
  const Intrinsics camera = testing::test_camera(203, 149);  // a width that fills no register
  cv::Mat_<float> depth = testing::render_depth(testing::looking_at_the_crate(), camera);
  depth(cv::Rect(20, 30, 37, 11)).setTo(kNaN);
  const auto pyramids = [&](InstructionSet set) {
    SurfacePyramid all = pyramid_from_depth(depth, camera, 1, 3, 3.0F, {}, kernels_for(set));
    for (const SurfaceMap& level : pyramid_from_surface(all.front(), 3, kernels_for(set))) {
      all.push_back(level);
    }
    return all;
  };
  const SurfacePyramid portable = pyramids(InstructionSet::kPortable);
  for (const InstructionSet set : kInstructionSets) {
    if (!is_supported(set)) continue;
    SCOPED_TRACE(name_of(set));
    const SurfacePyramid same = pyramids(set);
    for (std::size_t i = 0; i < portable.size(); ++i) {
      EXPECT_TRUE(same_bytes(same[i].depth_m, portable[i].depth_m)) << "level " << i;
      EXPECT_TRUE(same_bytes(same[i].normal_x, portable[i].normal_x)) << "level " << i;
      EXPECT_TRUE(same_bytes(same[i].normal_y, portable[i].normal_y)) << "level " << i;
      EXPECT_TRUE(same_bytes(same[i].normal_z, portable[i].normal_z)) << "level " << i;
    }
  }
}

TEST(CoveredShare, CountsThePointsInTheBox) {
  const Intrinsics camera = testing::test_camera(203, 149);
  const Pose X_WC = testing::looking_at_the_crate();
  SurfaceMap surface = testing::render_room(X_WC, camera);
  surface.depth_m(cv::Rect(20, 30, 37, 11)).setTo(kNaN);
  const Eigen::AlignedBox3d region_W(Eigen::Vector3d(-1.0, -0.7, -2.0),
                                     Eigen::Vector3d(1.03, 1.1, 1.9));
  int inside = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      inside += region_W.contains(X_WC * surface.point(v, u).cast<double>()) ? 1 : 0;
    }
  }
  const double share = static_cast<double>(inside) / (203 * 149);
  ASSERT_GT(share, 0.1);
  ASSERT_LT(share, 0.9);
  // A few points lie on the faces of the box, to rounding.
  EXPECT_NEAR(covered_share(surface, X_WC, region_W), share, 5.0 / (203 * 149));
  for (const InstructionSet set : kInstructionSets) {
    if (!is_supported(set)) continue;
    EXPECT_EQ(covered_share(surface, X_WC, region_W, kernels_for(set)),
              covered_share(surface, X_WC, region_W));
  }
  const double infinity = std::numeric_limits<double>::infinity();
  const Eigen::AlignedBox3d everywhere(Eigen::Vector3d::Constant(-infinity),
                                       Eigen::Vector3d::Constant(infinity));
  EXPECT_DOUBLE_EQ(covered_share(surface, X_WC, everywhere), 1.0 - 37.0 * 11.0 / (203 * 149));
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
