#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/objects/model/empty_space.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr float kResolution_m = 0.01F;

/// The side of a cube of 0.2 m around the origin that a camera at z = -1 sees.
std::vector<CloudPoint> front_of_cube() {
  std::vector<CloudPoint> points_O;
  for (int i = 0; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) {
      CloudPoint& p = points_O.emplace_back();
      p.x = 0.01F * static_cast<float>(i) - 0.1F;
      p.y = 0.01F * static_cast<float>(j) - 0.1F;
      p.z = -0.1F;
      p.nz = -1.0F;
    }
  }
  for (const float z : {0.0F, 0.1F}) {  // so that its box is the cube
    CloudPoint& p = points_O.emplace_back();
    p.z = z;
  }
  return points_O;
}

/// A camera at X_WC that measures the side of the cube before it, whose edges are worn, at 0.9 m
/// and a wall at 2 m.
MapView view_of_cube(const Pose& X_WC) {
  MapView view;
  view.X_WC = X_WC;
  view.intrinsics = {.fx = 130, .fy = 130, .cx = 79.5, .cy = 59.5, .width = 160, .height = 120};
  for (int j = 0; j < 120; ++j) {
    for (int i = 0; i < 160; ++i) {
      const double x_m = 0.9 * (i - 79.5) / 130;
      const double y_m = 0.9 * (j - 59.5) / 130;
      const bool is_cube = std::abs(x_m) <= 0.085 && std::abs(y_m) <= 0.085;
      view.depth_mm.push_back(is_cube ? 900 : 2000);
    }
  }
  return view;
}

Pose camera_before() {
  Pose X_WC = Pose::Identity();
  X_WC.translation() = Eigen::Vector3d(0, 0, -1);
  return X_WC;
}

/// Turned about the cube by a right angle: it looks along x.
Pose camera_beside() {
  return Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY()) * camera_before();
}

EmptySpace seen_from(const Pose& X_WC, const Pose& X_WO = Pose::Identity()) {
  ObservedSpace observed(kResolution_m);
  observed.add(view_of_cube(X_WO * X_WC));
  return empty_space(front_of_cube(), X_WO, observed);
}

TEST(EmptySpace, IsWhereACameraSawThrough) {
  const EmptySpace empty_O = seen_from(camera_before());
  EXPECT_FALSE(empty_O.is_unknown());
  EXPECT_TRUE(empty_O.contains({0.0F, 0.0F, -0.13F}));  // before the cube
  EXPECT_TRUE(empty_O.contains({0.13F, 0.0F, 0.0F}));   // beside it
  EXPECT_FALSE(empty_O.contains({0.0F, 0.0F, -0.1F}));  // its surface
  EXPECT_FALSE(empty_O.contains({0.0F, 0.0F, 0.05F}));  // inside
  EXPECT_FALSE(empty_O.contains({0.0F, 0.0F, 0.12F}));  // hidden by it
  EXPECT_FALSE(empty_O.contains({0.0F, 0.0F, -0.5F}));  // farther than a quarter of its size
  EXPECT_FALSE(empty_O.contains({NAN, 0.0F, -0.13F}));
}

TEST(EmptySpace, BelongsToTheObjectWhereverItStands) {
  const Pose X_WO = Eigen::Translation3d(3, -2, 1) *
                    Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized());
  const EmptySpace here = seen_from(camera_before());
  const EmptySpace there = seen_from(camera_before(), X_WO);
  std::size_t differ = 0;  // cells at the edge of what is seen through, by rounding
  for (std::size_t i = 0; i < here.is_empty().size(); ++i) {
    if (here.is_empty()[i] != there.is_empty()[i]) ++differ;
  }
  EXPECT_EQ(here.size(), there.size());
  EXPECT_LE(differ, here.is_empty().size() / 100);
}

TEST(EmptySpace, IsUnknownWithoutViewsAndOfAPoint) {
  EXPECT_TRUE(EmptySpace().is_unknown());
  EXPECT_FALSE(EmptySpace().contains(Eigen::Vector3f::Zero()));
  const ObservedSpace nothing(kResolution_m);
  EXPECT_TRUE(empty_space(front_of_cube(), Pose::Identity(), nothing).is_unknown());
  ObservedSpace observed(kResolution_m);
  observed.add(view_of_cube(camera_before()));
  EXPECT_TRUE(empty_space(std::vector<CloudPoint>(1), Pose::Identity(), observed).is_unknown());
}

TEST(EmptySpace, OfTwoLessonsIsWhatOneOfThemSaw) {
  const EmptySpace before = seen_from(camera_before());
  const EmptySpace beside = seen_from(camera_beside());
  const Eigen::Vector3f hidden_before(0.0F, 0.0F, 0.12F);
  const Eigen::Vector3f inside(0.0F, 0.0F, 0.05F);
  EXPECT_TRUE(beside.contains(hidden_before));
  // The second lesson has another frame, L.
  const Pose X_OL =
      Eigen::Translation3d(0.02, 0.01, 0.0) * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  std::vector<CloudPoint> points_L = front_of_cube();
  ObservedSpace observed(kResolution_m);
  observed.add(view_of_cube(camera_beside()));
  for (CloudPoint& p : points_L) {
    const Eigen::Vector3d p_L = X_OL.inverse() * Eigen::Vector3d(p.x, p.y, p.z);
    p.x = static_cast<float>(p_L.x());
    p.y = static_cast<float>(p_L.y());
    p.z = static_cast<float>(p_L.z());
  }
  const EmptySpace lesson_L = empty_space(points_L, X_OL, observed);
  const EmptySpace both = merged(front_of_cube(), before, lesson_L, X_OL);
  EXPECT_TRUE(both.contains(hidden_before));
  EXPECT_TRUE(both.contains({0.0F, 0.0F, -0.13F}));
  EXPECT_FALSE(both.contains(inside));
  EXPECT_TRUE(merged(front_of_cube(), {}, {}, X_OL).is_unknown());
  // Another lesson that saw nothing takes nothing away.
  EXPECT_EQ(merged(front_of_cube(), before, {}, X_OL), before);
}

TEST(EmptySpace, RefusesAGridThatIsNone) {
  const Eigen::Vector3f low_O = Eigen::Vector3f::Zero();
  const std::vector<bool> eight(8, true);
  EXPECT_NO_THROW(EmptySpace(low_O, 0.1F, {2, 2, 2}, eight));
  EXPECT_THROW(EmptySpace(low_O, 0.0F, {2, 2, 2}, eight), std::invalid_argument);
  EXPECT_THROW(EmptySpace(low_O, NAN, {2, 2, 2}, eight), std::invalid_argument);
  EXPECT_THROW(EmptySpace(low_O, 0.1F, {2, 2, 1}, eight), std::invalid_argument);
  EXPECT_THROW(EmptySpace(low_O, 0.1F, {-2, -2, 2}, eight), std::invalid_argument);
  EXPECT_THROW(EmptySpace(low_O, 0.1F, {17, 1, 1}, std::vector<bool>(17)), std::invalid_argument);
  EXPECT_THROW(EmptySpace({0, NAN, 0}, 0.1F, {2, 2, 2}, eight), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter
