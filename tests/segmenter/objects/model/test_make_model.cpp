#include <algorithm>
#include <random>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/model/make_model.hpp"
#include "segmenter/objects/model/merged_points.hpp"
#include "segmenter/objects/model/object_views.hpp"
#include "tests/segmenter/objects/box_on_table.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::box_on_table;
using testing::kBox;

CloudPoint point(float x, float y, float z, float nz = 1.0F) {
  CloudPoint p;
  p.x = x;
  p.y = y;
  p.z = z;
  p.nz = nz;
  p.weight = 1.0F;
  return p;
}

std::vector<CloudPoint> points_of_box(const ObservedMap& map) {
  std::vector<CloudPoint> points_W;
  for (std::size_t i = 0; i < map.points_W.size(); ++i) {
    if (map.segment_ids[i] == kBox) points_W.push_back(map.points_W[i]);
  }
  return points_W;
}

TEST(MergedPoints, AreOneWhereTwoLayersOfASurfaceLieCloseTogether) {
  CloudPoint heavy = point(0.012F, 0.0F, 0.003F);
  heavy.weight = 3.0F;
  const auto merged = merged_points(std::vector{point(0.01F, 0.0F, 0.0F), heavy}, 0.005F);
  ASSERT_EQ(merged.size(), 1U);
  EXPECT_FLOAT_EQ(merged[0].z, 0.00225F);
  EXPECT_FLOAT_EQ(merged[0].weight, 4.0F);
}

TEST(MergedPoints, AreTwoOnTheSidesOfAThinBoard) {
  const std::vector board{point(0.0F, 0.0F, 0.0F), point(0.0F, 0.0F, -0.001F, -1.0F)};
  EXPECT_EQ(merged_points(board, 0.005F).size(), 2U);
}

TEST(MergedPoints, DoNotDependOnTheOrder) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(0.0F, 0.1F);
  std::vector<CloudPoint> points;
  for (int i = 0; i < 500; ++i) points.push_back(point(place(random), place(random), 0.0F));
  const auto merged = merged_points(points, 0.01F);
  std::shuffle(points.begin(), points.end(), random);
  EXPECT_EQ(merged_points(points, 0.01F), merged);
  EXPECT_LT(merged.size(), 200U);
  EXPECT_GT(merged.size(), 60U);
}

TEST(MergedPoints, LeaveOutWhatMayNotBeInAMap) {
  EXPECT_TRUE(merged_points(std::vector{point(0.0F, 0.0F, 0.0F, 0.0F)}, 0.01F).empty());
}

TEST(MergeSurface, AveragesWhatBothHaveAndAddsTheRest) {
  std::vector<CloudPoint> points{point(0.0F, 0.0F, 0.0F)};
  const std::vector more{point(0.003F, 0.0F, 0.004F), point(0.05F, 0.0F, 0.0F)};
  EXPECT_EQ(merge_surface(points, more, 0.01F), 1U);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_FLOAT_EQ(points[0].x, 0.0F);  // along the surface it stays
  EXPECT_FLOAT_EQ(points[0].z, 0.002F);
  EXPECT_FLOAT_EQ(points[0].weight, 2.0F);
  EXPECT_FLOAT_EQ(points[1].x, 0.05F);
}

TEST(MakeModel, HasItsOriginInTheMeanAndZUp) {
  const ObservedMap map = box_on_table();
  const Eigen::Vector3d up_W(0.0, -1.0, 0.0);
  const auto points_W = points_of_box(map);
  const MadeModel made = make_model("box", points_W, map.resolution_m, up_W);
  EXPECT_TRUE(made.model.has_up);
  EXPECT_FLOAT_EQ(made.model.resolution_m, 0.01F);
  ASSERT_EQ(made.model.points_O.size(), points_W.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::AlignedBox3f box_O;
  int up = 0;
  for (const CloudPoint& p : made.model.points_O) {
    sum += Eigen::Vector3d(p.x, p.y, p.z);
    box_O.extend(Eigen::Vector3f(p.x, p.y, p.z));
    if (p.nz > 0.99F) ++up;
  }
  EXPECT_LT(sum.norm() / static_cast<double>(points_W.size()), 1e-6);
  EXPECT_EQ(up, 24 * 16);
  EXPECT_NEAR(box_O.sizes().z(), 0.12F, 0.011F);
  // Where it was.
  const CloudPoint back = transformed(made.model.points_O[0], made.X_WO);
  const bool is_there = std::any_of(points_W.begin(), points_W.end(), [&](const CloudPoint& p) {
    return std::hypot(p.x - back.x, p.y - back.y, p.z - back.z) < 1e-5F;
  });
  EXPECT_TRUE(is_there);
}

TEST(MakeModel, WithoutUpKeepsTheAxesOfTheMap) {
  const ObservedMap map = box_on_table();
  const MadeModel made = make_model("box", points_of_box(map), map.resolution_m, std::nullopt);
  EXPECT_FALSE(made.model.has_up);
  EXPECT_TRUE(made.X_WO.linear().isIdentity());
}

TEST(MakeModel, OfAFineMapHasAPointForEachSquareOf5mm) {
  testing::MapOfThings things(0.001F);
  things.add_face({0, 0, 0}, {0.1F, 0, 0}, {0, 0.1F, 0}, {1, 2, 3}, kBox);
  const MadeModel made = make_model("square", things.take().points_W, 0.001F, std::nullopt);
  EXPECT_FLOAT_EQ(made.model.resolution_m, 0.005F);
  EXPECT_GT(made.model.points_O.size(), 280U);  // 400 squares
  EXPECT_LT(made.model.points_O.size(), 560U);
}

TEST(MakeModel, WithoutAUsablePointIsRefused) {
  EXPECT_THROW(make_model("none", {}, 0.01F, std::nullopt), std::runtime_error);
}

/// A camera at p_W of U looks at the origin of U and measures `behind_m` more than is there.
MapView view_of_box(const MadeModel& made, const Eigen::Vector3d& p_U, double behind_m) {
  MapView view;
  const Eigen::Vector3d p_W = testing::MapOfThings::X_WU() * p_U;
  const Eigen::Vector3d forward = (made.X_WO.translation() - p_W).normalized();
  const Eigen::Vector3d right = forward.cross(-Eigen::Vector3d::UnitY()).normalized();
  view.X_WC.linear().col(0) = right;
  view.X_WC.linear().col(1) = forward.cross(right);
  view.X_WC.linear().col(2) = forward;
  view.X_WC.translation() = p_W;
  view.intrinsics = {.fx = 60, .fy = 60, .cx = 39.5, .cy = 29.5, .width = 80, .height = 60};
  view.depth_mm.assign(std::size_t{80} * 60, 0);
  for (const CloudPoint& p : made.model.points_O) {
    const Eigen::Vector3d p_C = view.X_WC.inverse() * (made.X_WO * Eigen::Vector3d(p.x, p.y, p.z));
    const auto u = static_cast<std::size_t>(std::lround(60 * p_C.x() / p_C.z() + 39.5));
    const auto v = static_cast<std::size_t>(std::lround(60 * p_C.y() / p_C.z() + 29.5));
    view.depth_mm.at(v * 80 + u) = static_cast<std::uint16_t>(1000 * (p_C.z() + behind_m));
  }
  return view;
}

TEST(ObjectViews, AreThoseThatMeasuredTheObject) {
  const ObservedMap map = box_on_table();
  const MadeModel made =
      make_model("box", points_of_box(map), map.resolution_m, Eigen::Vector3d(0.0, -1.0, 0.0));
  const Eigen::Vector3d in_front_U(0.0, -1.0, 0.5);
  const std::vector<MapView> views{view_of_box(made, in_front_U, 0.0),
                                   view_of_box(made, {0.05, -1.0, 0.5}, 0.0),  // nearly the same
                                   view_of_box(made, {0.9, -0.3, 0.5}, 0.3),   // looks through
                                   view_of_box(made, {0.8, -0.7, 0.4}, 0.0)};
  const auto directions_O =
      directions_of_views(made.model.points_O, made.X_WO, views, map.resolution_m);
  ASSERT_EQ(directions_O.size(), 2U);
  EXPECT_NEAR(directions_O[0].norm(), 1.0F, 1e-5F);
  EXPECT_GT(directions_O[0].z(), 0.3F);  // from above
  EXPECT_TRUE(directions_of_views(made.model.points_O, made.X_WO, {}, 0.01F).empty());
}

}  // namespace
}  // namespace kintsugi::segmenter
