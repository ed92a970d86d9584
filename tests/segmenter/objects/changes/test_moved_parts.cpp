// What changes and motions are decided by, each alone.

#include <cstdint>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/objects/changes/filled_space.hpp"
#include "segmenter/objects/changes/map_errors.hpp"
#include "segmenter/objects/changes/map_side.hpp"
#include "segmenter/objects/changes/motion_evidence.hpp"
#include "segmenter/objects/changes/surface_behind.hpp"
#include "segmenter/objects/changes/upright_motion.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"
#include "tests/segmenter/objects/toy_room.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::Box;

constexpr double kVoxel_m = 0.02;

/// All six faces of a box.
std::vector<CloudPoint> surface_of(const Box& box) {
  testing::ToyRoom room;
  room.size_m = {0.1, 0.1, 0.1};
  room.boxes = {box};
  ObservedMap map;
  testing::add_surfaces(room, kVoxel_m, map);
  std::vector<CloudPoint> points;
  for (std::size_t i = 0; i < map.points_W.size(); ++i) {
    if (map.segment_ids[i] == 7) points.push_back(map.points_W[i]);
  }
  return points;
}

const Box kBox{.center_S = {0.5, 1.0, 0.4}, .size_m = {0.4, 0.2, 0.8}, .color = {40, 160, 60}};

TEST(FilledSpace, IsThatOfABoxWithinItsMargins) {
  const FilledSpace space(surface_of(kBox), Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(space.contains({0.5F, 1.0F, 0.4F}, 0.05F));
  EXPECT_TRUE(space.contains({0.5F, 1.0F, 0.05F}, 0.04F));  // the vertical is exact
  EXPECT_FALSE(space.contains({0.5F, 1.0F, 0.02F}, 0.04F));
  EXPECT_FALSE(space.contains({0.5F, 1.0F, 0.85F}, 0.0F));
  EXPECT_TRUE(space.contains({0.5F, 1.0F, 0.85F}, -0.06F));
  EXPECT_FALSE(space.contains({0.8F, 1.0F, 0.4F}, 0.0F));
}

TEST(RefinedMotion, IsExactToAFractionOfAVoxel) {
  const std::vector<CloudPoint> before = surface_of(kBox);
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X.translation() = Eigen::Vector3d(0.3, -0.2, 0.1);
  const std::vector<CloudPoint> after = transformed(X, before);
  Pose rough = X;
  rough.linear() =
      rough.linear() *
      Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.3, 0.2, 0.9).normalized()).toRotationMatrix();
  rough.translation() =
      X * kBox.center_S + Eigen::Vector3d(0.04, -0.03, 0.02) - rough.linear() * kBox.center_S;
  const Pose found =
      refined_motion(before, after, rough, Eigen::Vector3d::UnitZ(), kVoxel_m, 6 * kVoxel_m);
  EXPECT_LT((found * kBox.center_S - X * kBox.center_S).norm(), 0.1 * kVoxel_m);
  EXPECT_LT(Eigen::AngleAxisd(found.linear().transpose() * X.linear()).angle(), 0.01);
  EXPECT_NEAR(found.linear()(2, 2), 1.0, 1e-9);  // upright
}

TEST(RefinedMotion, OfAFlatThingIsHeldByItsRim) {
  const Box flat{.center_S = {0.5, 1.0, 0.4}, .size_m = {0.4, 0.2, 0.01}};
  const std::vector<CloudPoint> before = surface_of(flat);
  Pose rough = Pose::Identity();
  rough.translation() = Eigen::Vector3d(0.03, 0.03, 0.0);
  const Pose found =
      refined_motion(before, before, rough, Eigen::Vector3d::UnitZ(), kVoxel_m, 6 * kVoxel_m);
  EXPECT_LT((found * flat.center_S - flat.center_S).norm(), 0.3 * kVoxel_m);
}

constexpr double kFine_m = 0.01;

/// A wall at y = `y_m` that faces -y.
MapSide wall(double y_m, const std::vector<std::uint32_t>& ids, const Eigen::Vector3i& color) {
  ObservedMap map;
  testing::add_face({0.0, y_m, 0.0}, {0.5, 0.0, 0.0}, {0.0, 0.0, 0.5}, -Eigen::Vector3d::UnitY(),
                    color, 1, kFine_m, map);
  return {map.points_W, std::span(ids).first(map.points_W.size()), kFine_m};
}

TEST(SurfaceBehind, IsFartherThanTheErrorOfTheMapsAndNearerThanThatOfAView) {
  const std::vector<std::uint32_t> ids(10'000, 1);
  const MapSide map = wall(2.0, ids, {200, 200, 200});
  const auto is_behind = [&](double y_m, const Eigen::Vector3f& normal) -> bool {
    CloudPoint point = map.points()[1275];  // in the middle
    point.y = static_cast<float>(y_m);
    point.nx = normal.x();
    point.ny = normal.y();
    point.nz = normal.z();
    return have_surface_behind({&point, 1}, map, 2.0 * map.voxel_m()).front();
  };
  EXPECT_TRUE(is_behind(1.96, -Eigen::Vector3f::UnitY()));
  EXPECT_FALSE(is_behind(1.99, -Eigen::Vector3f::UnitY()));  // it is the wall
  EXPECT_FALSE(is_behind(1.9, -Eigen::Vector3f::UnitY()));
  EXPECT_FALSE(is_behind(2.04, -Eigen::Vector3f::UnitY()));  // the wall is before it
  EXPECT_FALSE(is_behind(1.96, Eigen::Vector3f::UnitY()));   // a back
}

TEST(MapErrors, AreThoseOfMostOfTheSurface) {
  const std::vector<std::uint32_t> ids(10'000, 1);
  const MapSide map = wall(2.0, ids, {200, 200, 200});
  const MapErrors none = errors_of(map, map);
  EXPECT_EQ(none.distance_m, kLeastError_vox * kFine_m);
  EXPECT_EQ(none.color, kSameColor);
  const MapErrors errors = errors_of(map, wall(2.03, ids, {90, 90, 200}));
  EXPECT_NEAR(errors.distance_m, 4 * 0.03, 1e-3);
  EXPECT_GT(errors.color, 4 * kSameColor);
  EXPECT_EQ(errors_of(map, wall(2.5, ids, {90, 90, 200})).distance_m, none.distance_m)
      << "the maps have no surface in common";
}

TEST(MapErrors, AreNotWhatASmallPartOfTheRoomDiffersBy) {
  const std::vector<std::uint32_t> ids(10'000, 1);
  const MapSide map = wall(2.0, ids, {200, 200, 200});
  std::vector<CloudPoint> points = map.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 100 < 15) points[i].y += 0.05F;
    if (i % 100 < 15) points[i].red = 20;
  }
  const MapErrors errors = errors_of({points, map.segment_ids(), kFine_m}, map);
  EXPECT_EQ(errors.distance_m, kLeastError_vox * kFine_m);
  EXPECT_EQ(errors.color, kSameColor);
}

TEST(Evidence, IsOfPlaceDirectionAndColor) {
  const std::vector<std::uint32_t> ids(10'000, 1);
  const MapSide map = wall(2.0, ids, {200, 200, 200});
  const MapSide other = wall(2.5, ids, {20, 20, 120});
  std::vector<std::size_t> all(map.points().size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  Pose X = Pose::Identity();
  EXPECT_EQ(evidence_of(map, all, X, map).found, 1.0);
  X.translation().x() = 0.25;
  EXPECT_NEAR(evidence_of(map, all, X, map).found, 0.5, 0.05);
  EXPECT_EQ(evidence_of(map, all, X, map).contradicted, 0.0);  // nobody looked there
  X.translation() = Eigen::Vector3d(0.0, 0.5, 0.0);
  EXPECT_EQ(evidence_of(map, all, X, other).contradicted, 1.0);  // another colour
}

}  // namespace
}  // namespace kintsugi::segmenter
