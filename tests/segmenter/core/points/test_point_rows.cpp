#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/points/point_rows.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::CloudShape;
using testing::random_cloud;
using Pairs = std::vector<std::pair<PointIndex, PointIndex>>;  // ascending, each (i, j), i < j

constexpr float kRadius_m = 0.02F;

CloudPoint at(float x, float y, float z) {
  CloudPoint p;
  p.x = x;
  p.y = y;
  p.z = z;
  p.nz = 1.0F;
  return p;
}

template <typename Keep>
Pairs pairs_of(const PointRows& rows, const Keep& keep) {
  Pairs pairs;
  for (std::size_t row = 0; row < rows.num_rows(); ++row) {
    rows.for_each_pair(row, keep, [&](PointRows::Slot a, PointRows::Slot b) {
      pairs.emplace_back(std::minmax(rows.points()[a].index, rows.points()[b].index));
    });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

Pairs brute_force(const PointCloud& cloud, const std::vector<PointIndex>& points, float radius_m) {
  Pairs pairs;
  for (const PointIndex i : points) {
    for (const PointIndex j : points) {
      if (i < j && are_neighbours(cloud[i], cloud[j], radius_m)) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

constexpr auto kAll = [](PointRows::Slot, PointRows::Slot) { return true; };

void expect_as_brute_force(const std::vector<CloudPoint>& points, float radius_m = kRadius_m) {
  PointCloud cloud;
  cloud.add_slice(0, points);
  const std::vector<PointIndex> all = cloud.take_change().added;
  EXPECT_EQ(pairs_of(PointRows(cloud, all, radius_m), kAll), brute_force(cloud, all, radius_m));
}

std::vector<CloudPoint> random_box(int count, double corner_m, double extent_m, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> coordinate(corner_m, corner_m + extent_m);
  std::vector<CloudPoint> points;
  for (int k = 0; k < count; ++k) {
    const auto x = static_cast<float>(coordinate(generator));
    const auto y = static_cast<float>(coordinate(generator));
    points.push_back(at(x, y, static_cast<float>(coordinate(generator))));
  }
  return points;
}

TEST(PointRows, NoPointsHaveNoRows) {
  PointCloud cloud;
  EXPECT_EQ(PointRows(cloud, {}, kRadius_m).num_rows(), 0U);
}

TEST(PointRows, DenseBoxesAroundTheOriginAndFarFromIt) {
  for (unsigned seed = 0; seed < 4; ++seed) expect_as_brute_force(random_box(900, -0.1, 0.2, seed));
  expect_as_brute_force(random_box(900, 1000.0, 0.15, 5));
  expect_as_brute_force(random_box(900, -1000.1, 0.15, 6));
  expect_as_brute_force(random_box(600, 999990.0, 0.5, 7));  // steps of 6 cm: r is less
}

TEST(PointRows, LatticeWhoseStepsAreExactlyTheRadius) {
  std::vector<CloudPoint> points;
  for (int x = -6; x < 6; ++x) {
    for (int y = -6; y < 6; ++y) {
      for (int z = -2; z < 3; ++z) {
        const auto step = [](int k) { return static_cast<float>(k) * (kRadius_m / 2.0F); };
        points.push_back(at(step(x), step(y), step(z)));
      }
    }
  }
  expect_as_brute_force(points);
}

TEST(PointRows, DuplicatesAreEachOthersNeighbours) {
  std::vector<CloudPoint> points(200, at(0.3F, -0.7F, 1.0F));
  points.push_back(at(0.3F, -0.7F, 1.01F));
  points.push_back(at(-0.0F, 0.0F, 0.0F));
  points.push_back(at(0.0F, -0.0F, 0.0F));
  expect_as_brute_force(points);
}

TEST(PointRows, CoordinatesBeyondTheLastCell) {
  // Cells of 3 mm end at 800 km: all of these share the last one.
  std::vector<CloudPoint> points;
  for (const float far : {1e7F, 1e30F, -1e30F}) {
    points.push_back(at(0.0F, far, 0.0F));
    points.push_back(at(0.001F, far, 0.0F));
    points.push_back(at(0.0F, 0.0F, far));
    points.push_back(at(0.0F, 0.001F, far));
    points.push_back(at(far, far, far));
    points.push_back(at(far, far, far));
  }
  expect_as_brute_force(points, 0.003F);
}

TEST(PointRows, OtherRadii) {
  for (const float radius_m : {0.003F, 0.05F, 0.7F, 3.0F}) {
    expect_as_brute_force(random_box(500, -1.5 * radius_m, 5.0 * radius_m, 11), radius_m);
  }
}

TEST(PointRows, TakesOnlyThePointsGiven) {
  PointCloud cloud;
  cloud.add_slice(0, random_cloud(CloudShape::kWaves, 800, 3));
  std::vector<PointIndex> some;
  for (PointIndex i = 0; i < cloud.size(); i += 2) some.push_back(i);
  EXPECT_EQ(pairs_of(PointRows(cloud, some, kRadius_m), kAll), brute_force(cloud, some, kRadius_m));
}

TEST(PointRows, LeavesOutPairsThatAreNotKept) {
  PointCloud cloud;
  cloud.add_slice(0, random_cloud(CloudShape::kWaves, 800, 3));
  const std::vector<PointIndex> all = cloud.take_change().added;
  const PointRows rows(cloud, all, kRadius_m);
  Pairs expected = brute_force(cloud, all, kRadius_m);
  std::erase_if(expected, [](const auto& pair) { return (pair.first + pair.second) % 3 == 0; });
  EXPECT_EQ(pairs_of(rows,
                     [&](PointRows::Slot a, PointRows::Slot b) {
                       return (rows.points()[a].index + rows.points()[b].index) % 3 != 0;
                     }),
            expected);
}

}  // namespace
}  // namespace kintsugi::segmenter
