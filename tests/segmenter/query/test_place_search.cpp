#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "segmenter/query/place_search.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::make_point;

constexpr float kVoxel_m = 0.01F;

/// Points that carry segment ids; looked at as a LabelledCloud.
struct Labelled {
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> segment_ids;

  void add(const CloudPoint& point, std::uint32_t id) {
    points_W.push_back(point);
    segment_ids.push_back(id);
  }
  [[nodiscard]] LabelledCloud cloud() const {
    return {points_W, segment_ids, kVoxel_m, 2.0F * kVoxel_m};
  }
};

/// A square of `side_vox` voxels parallel to x and y, its centre at (0, 0, z), facing the origin.
void add_square(double z, int side_vox, std::uint32_t id, Labelled& labelled) {
  for (int i = 0; i < side_vox; ++i) {
    for (int j = 0; j < side_vox; ++j) {
      const double first = -0.5 * (side_vox - 1);
      labelled.add(make_point((first + i) * kVoxel_m, (first + j) * kVoxel_m, z, 0, 0, -1), id);
    }
  }
}

Labelled random_labelled() {
  Labelled labelled;
  labelled.points_W = testing::random_cloud(testing::CloudShape::kWaves, 3'000, 3);
  std::mt19937 random(4);
  for (std::size_t i = 0; i < labelled.points_W.size(); ++i) {
    labelled.segment_ids.push_back(random() % 20);  // 0: of no segment
  }
  return labelled;
}

Eigen::Vector3d random_place(std::mt19937& random) {
  std::uniform_real_distribution<double> coordinate(-0.1, 0.7);
  return {coordinate(random), coordinate(random), 0.1 * coordinate(random)};
}

double distance_m(const CloudPoint& point, const Eigen::Vector3d& p_W) {
  return (Eigen::Vector3f(point.x, point.y, point.z).cast<double>() - p_W).norm();
}

TEST(PlaceSearch, NearestPointIsTheFirstOfAllByDistance) {
  const Labelled labelled = random_labelled();
  std::mt19937 random(5);
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector3d p_W = random_place(random);
    std::vector<std::pair<double, std::size_t>> by_distance;
    for (std::size_t i = 0; i < labelled.points_W.size(); ++i) {
      if (labelled.segment_ids[i] == kNoSegment) continue;
      by_distance.emplace_back(distance_m(labelled.points_W[i], p_W), i);
    }
    std::sort(by_distance.begin(), by_distance.end());
    const auto [nearest_m, place] = by_distance.front();
    const auto hit = nearest_point(labelled.cloud(), p_W, 0.03);
    ASSERT_EQ(hit.has_value(), nearest_m <= 0.03);
    if (!hit) continue;
    ++found;
    EXPECT_EQ(hit->point, place);
    EXPECT_NEAR(hit->distance_m, nearest_m, 1e-12);  // summed in another order
  }
  EXPECT_GT(found, 20);
  EXPECT_LT(found, 180);
}

TEST(PlaceSearch, BoxHoldsTheSegmentsOfItsPointsFacesIncluded) {
  const Labelled labelled = random_labelled();
  std::mt19937 random(6);
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::AlignedBox3d box_W(random_place(random));
    box_W.extend(random_place(random));
    std::set<std::uint32_t> expected;
    for (std::size_t i = 0; i < labelled.points_W.size(); ++i) {
      const CloudPoint& p = labelled.points_W[i];
      const bool is_in = box_W.min().x() <= p.x && p.x <= box_W.max().x() &&
                         box_W.min().y() <= p.y && p.y <= box_W.max().y() &&
                         box_W.min().z() <= p.z && p.z <= box_W.max().z();
      if (is_in && labelled.segment_ids[i] != kNoSegment) expected.insert(labelled.segment_ids[i]);
    }
    EXPECT_EQ(segments_in_box(labelled.cloud(), box_W),
              std::vector(expected.begin(), expected.end()));
  }
  const CloudPoint& p = labelled.points_W[1];
  const Eigen::Vector3d p_W(p.x, p.y, p.z);
  ASSERT_NE(labelled.segment_ids[1], kNoSegment);
  EXPECT_EQ(segments_in_box(labelled.cloud(), {p_W, p_W}), std::vector{labelled.segment_ids[1]});
}

TEST(PlaceSearch, MeasuredSurfaceIsNeitherBehindNorInFrontOfWhatIsMeasured) {
  Labelled labelled;
  add_square(1.0, 20, 1, labelled);
  add_square(2.0, 60, 2, labelled);
  add_square(3.0, 90, 3, labelled);
  const Ray forward{{0, 0, 0}, {0, 0, 1}};
  const double radius_m = 0.03;
  for (int wall = 1; wall <= 3; ++wall) {
    for (const double off_m : {-0.025, 0.0, 0.025}) {
      const auto hit = measured_surface(labelled.cloud(), {forward, wall + off_m}, radius_m);
      ASSERT_TRUE(hit);
      EXPECT_EQ(labelled.segment_ids[hit->point], static_cast<std::uint32_t>(wall));
      EXPECT_NEAR(hit->distance_m, wall, 1e-6);  // of the map, not of the measurement
    }
    EXPECT_FALSE(measured_surface(labelled.cloud(), {forward, wall + 0.04}, radius_m));
    EXPECT_FALSE(measured_surface(labelled.cloud(), {forward, wall - 0.04}, radius_m));
  }
}

TEST(PlaceSearch, MeasuredSurfaceFacesTheCamera) {
  Labelled board;  // 2 cm thick, measured in its middle
  board.add(make_point(0, 0, 1.0, 0, 0, -1), 1);
  board.add(make_point(0, 0, 1.02, 0, 0, 1), 2);
  const MeasuredPoint measured{{{0, 0, 0}, {0, 0, 1}}, 1.015};
  const auto front = measured_surface(board.cloud(), measured, 0.03);
  ASSERT_TRUE(front);
  EXPECT_EQ(board.segment_ids[front->point], 1U);
  board.segment_ids[0] = kNoSegment;
  EXPECT_FALSE(measured_surface(board.cloud(), measured, 0.03));
}

TEST(PlaceSearch, RayMeetsAPlaneWhereItIsAndNamesTheNearestPointThere) {
  Labelled labelled;
  add_square(2.0, 60, 7, labelled);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> slope(-0.12, 0.12);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector3d to_plane_W(2.0 * slope(random), 2.0 * slope(random), 2.0);
    const Ray ray{{0, 0, 0}, to_plane_W.normalized()};
    const auto hit = visible_point(labelled.cloud(), ray, 2.0 * kVoxel_m);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance_m, to_plane_W.norm(), 1e-6);  // coordinates are float32
    // In a lattice the nearest point is half a diagonal of a cell away at most.
    EXPECT_LE(distance_m(labelled.points_W[hit->point], to_plane_W), 0.7072 * kVoxel_m);
  }
}

TEST(PlaceSearch, RayStopsAtTheFirstSurfaceThatFacesIt) {
  Labelled labelled;
  add_square(3.0, 60, 3, labelled);
  add_square(2.0, 10, 2, labelled);
  labelled.add(make_point(0, 0, 1.0, 0, 0, 1), 1);    // seen from behind
  labelled.add(make_point(0, 0, 1.5, 1, 0, 0), 4);    // seen from the side
  labelled.add(make_point(0, 0, -1.0, 0, 0, -1), 5);  // behind the camera
  labelled.add(make_point(0, 0, 1.2, 0, 0, -1), kNoSegment);
  const Ray forward{{0, 0, 0}, {0, 0, 1}};
  const auto hit = visible_point(labelled.cloud(), forward, 2.0 * kVoxel_m);
  ASSERT_TRUE(hit);
  EXPECT_EQ(labelled.segment_ids[hit->point], 2U);
  EXPECT_NEAR(hit->distance_m, 2.0, 1e-6);

  CloudPoint without_normal;
  without_normal.z = 0.5F;
  labelled.add(without_normal, 6);
  EXPECT_EQ(labelled.segment_ids[visible_point(labelled.cloud(), forward, 0.02)->point], 6U);
}

TEST(PlaceSearch, ObjectBeforeAWallIsNoWiderThanAVoxelMore) {
  Labelled labelled;
  add_square(2.0, 200, 1, labelled);
  add_square(1.0, 20, 2, labelled);  // up to 0.095 m from the axis
  const auto seen_at = [&](double x_m) {
    const Eigen::Vector3d to_W(x_m, 0.003, 1.0);
    const auto hit = visible_point(labelled.cloud(), {{0, 0, 0}, to_W.normalized()}, 0.02);
    return hit ? labelled.segment_ids[hit->point] : kNoSegment;
  };
  for (const double x_m : {0.0, 0.05, 0.094, -0.094}) EXPECT_EQ(seen_at(x_m), 2U) << x_m;
  for (const double x_m : {0.106, 0.11, -0.106, 0.3}) EXPECT_EQ(seen_at(x_m), 1U) << x_m;
}

TEST(PlaceSearch, RayPassesAHoleThatIsWiderThanTheRadius) {
  Labelled labelled;
  add_square(2.0, 2, 1, labelled);  // its points 0.7 voxels from the axis
  const Ray forward{{0, 0, 0}, {0, 0, 1}};
  EXPECT_TRUE(visible_point(labelled.cloud(), forward, kVoxel_m));
  EXPECT_FALSE(visible_point(labelled.cloud(), forward, 0.7 * kVoxel_m));
  EXPECT_FALSE(visible_point(LabelledCloud{}, forward, kVoxel_m));
}

}  // namespace
}  // namespace kintsugi::segmenter
