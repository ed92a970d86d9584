#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/frame/surface_pyramid.hpp"
#include "mapper/core/relocalization/keyframe_map.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper {
namespace {

using ::testing::ElementsAre;

Pose moved(double x_m, double angle_rad = 0.0) {
  Pose X = Pose::Identity();
  X.translation().x() = x_m;
  X.linear() = Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return X;
}

TrackingInput flat_frame(float depth_m) {
  const Intrinsics camera = testing::test_camera();
  return {0,
          pyramid_from_depth(cv::Mat_<float>(camera.height, camera.width, depth_m), camera, 0, 3,
                             10.0F),
          {}};
}

void add(KeyframeMap& map, const Pose& X_WC, float depth_m) {
  const TrackingInput frame = flat_frame(depth_m);
  map.add(X_WC, frame, frame.surface_C[1]);
}

TEST(KeyframeMap, FindsTheNearestKeyframeWithinTheSpacing) {
  KeyframeMap map({});
  EXPECT_EQ(map.find_near(Pose::Identity()), std::nullopt);
  add(map, Pose::Identity(), 1.0F);
  add(map, moved(0.2), 1.0F);
  EXPECT_EQ(map.find_near(moved(-0.14)), 0);
  EXPECT_EQ(map.find_near(moved(0.09)), 0);
  EXPECT_EQ(map.find_near(moved(0.11)), 1);
  EXPECT_EQ(map.find_near(moved(0.36)), std::nullopt);
  EXPECT_EQ(map.find_near(moved(0.0, 0.16)), 0);
  EXPECT_EQ(map.find_near(moved(0.0, 0.18)), std::nullopt);
}

TEST(KeyframeMap, APoseNearAReleasedKeyframeMayBecomeOneAgain) {
  KeyframeMap map({});
  add(map, Pose::Identity(), 1.0F);
  add(map, moved(0.2), 1.0F);
  map.release_if([](const Keyframe& keyframe) { return keyframe.X_WC.translation().x() > 0.1; });
  EXPECT_THAT(map.is_released(), ::testing::ElementsAre(false, true));
  EXPECT_EQ(map.find_near(moved(0.12)), 0);
  EXPECT_EQ(map.find_near(moved(0.2)), std::nullopt);
  map.release_if([](const Keyframe&) { return false; });
  EXPECT_TRUE(map.is_released()[1]) << "what has left does not come back";
}

TEST(KeyframeMap, StaysSmallWhileTheCameraStaysInOnePlace) {
  KeyframeMap map({});
  for (int i = 0; i < 1000; ++i) {
    const Pose X_WC = moved(0.1 * std::sin(0.1 * i), 0.1 * std::cos(0.07 * i));
    if (!map.find_near(X_WC)) add(map, X_WC, 1.0F);
  }
  // 0.2 m by 0.2 rad at a spacing of 0.15 m and 0.17 rad, wherever the first one is.
  EXPECT_LE(map.size(), 9);
}

TEST(KeyframeMap, RanksByDepthAndPrefersTheEarlierOfEquals) {
  KeyframeMap map({});
  for (const float depth_m : {3.0F, 1.0F, 2.0F, 1.0F}) add(map, moved(map.size()), depth_m);
  const KeyframeAppearance appearance = appearance_of(flat_frame(1.1F), 0);
  EXPECT_THAT(map.similar_to(appearance, [](int) { return true; }), ElementsAre(1, 3, 2, 0));
  EXPECT_THAT(map.similar_to(appearance, [](int i) { return i != 3; }), ElementsAre(1, 2, 0));
}

TEST(KeyframeMap, KeepsTheSurfaceToAQuarterOfAMillimetre) {
  KeyframeMap map({});
  TrackingInput frame = flat_frame(1.2345F);
  frame.surface_C[1].depth_m(0, 0) = std::numeric_limits<float>::quiet_NaN();
  map.add(Pose::Identity(), frame, frame.surface_C[1]);
  map.finish_last();
  const SurfaceMap surface = map[0].surface();
  EXPECT_EQ(surface.intrinsics, frame.surface_C[1].intrinsics);
  EXPECT_NEAR(surface.depth_m(60, 80), 1.2345, 0.000126);
  EXPECT_TRUE(std::isnan(surface.depth_m(0, 0)));
}

TEST(KeyframeAppearance, ComparesThumbnailsByRelativeDepth) {
  const cv::Mat_<float> one = appearance_of(flat_frame(1.0F), 0).thumbnail_m;
  const cv::Mat_<float> further = appearance_of(flat_frame(1.2F), 0).thumbnail_m;
  EXPECT_EQ(thumbnail_difference(one, one), 0.0);
  EXPECT_NEAR(thumbnail_difference(one, further), 0.2 / 1.1, 1e-6);
  const cv::Mat_<float> nothing = appearance_of(flat_frame(std::nanf("")), 0).thumbnail_m;
  EXPECT_TRUE(std::isinf(thumbnail_difference(one, nothing)));
}

TEST(KeyframeMapConfig, NamesTheFieldOutOfRange) {
  KeyframeMap::Config config;
  config.spacing_m = 0.0;
  EXPECT_THROW(KeyframeMap{config}, std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper
