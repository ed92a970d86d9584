#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/graph/make_neighbour_index.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"

namespace kintsugi::segmenter {
namespace {

using Neighbours = std::vector<std::vector<PointIndex>>;  // of each point, ascending

constexpr float kRadius_m = 0.02F;

CloudPoint at(float x, float y, float z) {
  CloudPoint p;
  p.x = x;
  p.y = y;
  p.z = z;
  p.nz = 1.0F;
  return p;
}

/// The definition of neighbours, applied to all pairs.
Neighbours brute_force(const PointCloud& cloud, float radius_m) {
  Neighbours all(cloud.size());
  const float limit = radius_m * radius_m;
  for (PointIndex i = 0; i < cloud.size(); ++i) {
    for (PointIndex j = 0; j < cloud.size(); ++j) {
      if (i == j) continue;
      const float dx = cloud[i].x - cloud[j].x;
      const float dy = cloud[i].y - cloud[j].y;
      const float dz = cloud[i].z - cloud[j].z;
      const float xy = dx * dx + dy * dy;
      if (xy + dz * dz < limit) all[i].push_back(j);
    }
  }
  return all;
}

Neighbours visit_all(const NeighbourIndex& index, PointIndex num_points) {
  Neighbours all(num_points);
  std::vector<int> visits(num_points, 0);
  std::mutex mutex;
  index.visit_all([&](PointIndex i, std::span<const PointIndex> neighbours) {
    const std::lock_guard lock(mutex);
    ++visits[i];
    all[i].assign(neighbours.begin(), neighbours.end());
    std::sort(all[i].begin(), all[i].end());
  });
  EXPECT_THAT(visits, testing::Each(1));
  return all;
}

Neighbours visit_some(const NeighbourIndex& index, PointIndex num_points,
                      const std::vector<PointIndex>& points) {
  Neighbours all(num_points);
  std::mutex mutex;
  index.visit_concurrently(points, [&](PointIndex i, std::span<const PointIndex> neighbours) {
    const std::lock_guard lock(mutex);
    all[i].assign(neighbours.begin(), neighbours.end());
    std::sort(all[i].begin(), all[i].end());
  });
  return all;
}

class NeighbourIndexTest : public testing::TestWithParam<NeighbourSearch> {
 protected:
  void expect_as_brute_force(const std::vector<CloudPoint>& points, float radius_m = kRadius_m) {
    PointCloud cloud;
    cloud.add_slice(0, points);
    ASSERT_EQ(cloud.size(), points.size());
    const auto index = make_neighbour_index(GetParam(), cloud, radius_m);
    index->insert(cloud.take_change().added);
    EXPECT_EQ(visit_all(*index, cloud.size()), brute_force(cloud, radius_m));
  }

  /// `count` points in a cube with edges of `extent_m` at `corner_m` on each axis.
  static std::vector<CloudPoint> random_points(int count, double corner_m, double extent_m,
                                               unsigned seed) {
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
};

TEST_P(NeighbourIndexTest, EmptyCloudHasNoPointToVisit) { expect_as_brute_force({}); }

TEST_P(NeighbourIndexTest, SinglePointHasNoNeighbour) { expect_as_brute_force({at(0, 0, 0)}); }

TEST_P(NeighbourIndexTest, DenseCloudAroundTheOrigin) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    expect_as_brute_force(random_points(1500, -0.1, 0.2, seed));
  }
}

TEST_P(NeighbourIndexTest, CloudOverManyBlocksAndTiles) {
  std::vector<CloudPoint> points = random_points(3000, -2.3, 4.6, 7);
  const std::size_t spread = points.size();
  for (std::size_t k = 0; k < spread; ++k) {  // company for each, or few have neighbours
    points.push_back(at(points[k].x + 0.013F, points[k].y - 0.009F, points[k].z + 0.004F));
  }
  expect_as_brute_force(points);
}

TEST_P(NeighbourIndexTest, FarFromTheOriginWhereFloatsAreCoarse) {
  expect_as_brute_force(random_points(1500, 1000.0, 0.15, 3));
  expect_as_brute_force(random_points(1500, -1000.1, 0.15, 4));
  expect_as_brute_force(random_points(800, 999990.0, 0.5, 5));  // steps of 6 cm: r is less
}

TEST_P(NeighbourIndexTest, PointsOnTheBordersOfCellsAndTiles) {
  std::vector<CloudPoint> points;
  for (const float centre : {-1.0F, 0.0F, 1.0F, 0.16F}) {
    for (const float x : {-0.02F, -0.01F, -0.0F, 1e-7F, 0.01F, 0.019999F}) {
      for (const float y : {-0.01F, 0.0F, 0.0199F}) {
        points.push_back(at(centre + x, centre + y, centre));
        points.push_back(at(centre, centre + x, -centre + y));
      }
    }
  }
  expect_as_brute_force(points);
}

TEST_P(NeighbourIndexTest, LatticeWhoseStepsAreExactlyTheRadius) {
  std::vector<CloudPoint> points;
  for (int x = -8; x < 8; ++x) {
    for (int y = -8; y < 8; ++y) {
      for (int z = -1; z < 2; ++z) {
        const auto step = [](int k) { return static_cast<float>(k) * (kRadius_m / 2.0F); };
        points.push_back(at(step(x), step(y), step(z)));
      }
    }
  }
  expect_as_brute_force(points);
}

TEST_P(NeighbourIndexTest, PlacesThatAreNoPointsHaveTheNeighboursOfAPointThere) {
  const auto points = random_points(400, 0.0, 0.12, 9);
  PointCloud cloud;
  cloud.add_slice(0, points);
  const auto index = make_neighbour_index(GetParam(), cloud, kRadius_m);
  const auto all = cloud.take_change().added;
  index->insert(std::span(all).first(200));
  const std::span places_W = std::span(points).subspan(200);
  PointIndex expected_place = 0;
  index->visit_places(places_W, [&](PointIndex k, std::span<const PointIndex> neighbours) {
    EXPECT_EQ(k, expected_place++);
    std::vector<PointIndex> expected;
    for (PointIndex i = 0; i < 200; ++i) {
      if (are_neighbours(places_W[k], points[i], kRadius_m)) expected.push_back(i);
    }
    EXPECT_THAT(neighbours, ::testing::UnorderedElementsAreArray(expected));
  });
  EXPECT_EQ(expected_place, places_W.size());
}

TEST_P(NeighbourIndexTest, RadiusIsExclusive) {
  PointCloud cloud;
  const float below = std::nextafter(kRadius_m, 0.0F);
  cloud.add_slice(0, std::vector{at(0, 0, 0), at(kRadius_m, 0, 0), at(-below, 0, 0)});
  const auto index = make_neighbour_index(GetParam(), cloud, kRadius_m);
  index->insert(cloud.take_change().added);
  EXPECT_EQ(visit_all(*index, 3), (Neighbours{{2}, {}, {0}}));
}

TEST_P(NeighbourIndexTest, DuplicatesAreEachOthersNeighbours) {
  std::vector<CloudPoint> points(300, at(0.3F, -0.7F, 1.0F));
  points.push_back(at(0.3F, -0.7F, 1.01F));
  expect_as_brute_force(points);
}

TEST_P(NeighbourIndexTest, OtherRadii) {
  for (const float radius_m : {0.003F, 0.05F, 0.7F, 3.0F}) {
    expect_as_brute_force(random_points(700, -1.5 * radius_m, 5.0 * radius_m, 11), radius_m);
  }
}

TEST_P(NeighbourIndexTest, GrowsSliceBySlice) {
  PointCloud cloud;
  const auto index = make_neighbour_index(GetParam(), cloud, kRadius_m);
  for (int slice = 0; slice < 6; ++slice) {
    const unsigned seed = 20U + static_cast<unsigned>(slice);
    cloud.add_slice(slice, random_points(slice == 3 ? 0 : 300, 0.9, 0.2, seed));
    index->insert(cloud.take_change().added);
    EXPECT_EQ(visit_all(*index, cloud.size()), brute_force(cloud, kRadius_m));
  }
}

/// brute_force() without the points in `gone`.
Neighbours brute_force_without(const PointCloud& cloud, const std::set<PointIndex>& gone) {
  Neighbours all = brute_force(cloud, kRadius_m);
  for (PointIndex i = 0; i < cloud.size(); ++i) {
    if (gone.contains(i)) all[i].clear();
    std::erase_if(all[i], [&](PointIndex j) { return gone.contains(j); });
  }
  return all;
}

TEST_P(NeighbourIndexTest, FindsNoRemovedPointAndAgainAfterInsertingIt) {
  PointCloud cloud;
  cloud.add_slice(0, random_points(1200, -0.15, 0.3, 41));
  const auto index = make_neighbour_index(GetParam(), cloud, kRadius_m);
  index->insert(cloud.take_change().added);
  std::mt19937 generator(7);
  std::set<PointIndex> gone;
  for (int step = 0; step < 8; ++step) {
    std::vector<PointIndex> removed;
    std::vector<PointIndex> inserted;
    for (PointIndex i = 0; i < cloud.size(); ++i) {
      if (generator() % 4 != 0) continue;
      (gone.contains(i) ? inserted : removed).push_back(i);
    }
    index->remove(removed);
    index->insert(inserted);
    gone.insert(removed.begin(), removed.end());
    for (const PointIndex i : inserted) gone.erase(i);

    std::vector<PointIndex> present;
    for (PointIndex i = 0; i < cloud.size(); ++i) {
      if (!gone.contains(i)) present.push_back(i);
    }
    const Neighbours expected = brute_force_without(cloud, gone);
    EXPECT_EQ(visit_some(*index, cloud.size(), present), expected);
    Neighbours all(cloud.size());
    std::mutex mutex;
    index->visit_all([&](PointIndex i, std::span<const PointIndex> neighbours) {
      const std::lock_guard lock(mutex);
      EXPECT_FALSE(gone.contains(i));
      all[i].assign(neighbours.begin(), neighbours.end());
      std::sort(all[i].begin(), all[i].end());
    });
    EXPECT_EQ(all, expected);
  }
}

// The points of each round are elsewhere, in part in the blocks of the round before.
TEST_P(NeighbourIndexTest, AssignedPointsReplaceWhateverWasInIt) {
  PointCloud cloud;
  const auto index = make_neighbour_index(GetParam(), cloud, kRadius_m);
  for (int round = 0; round < 4; ++round) {
    const std::vector<CloudPoint> points =
        random_points(1500, -0.3 + 0.2 * round, 0.4, 48U + static_cast<unsigned>(round));
    if (round == 0) {
      cloud.add_slice(0, points);
    } else {
      cloud.replace_slice(0, points);
    }
    cloud.take_change();
    const std::vector<PointIndex> live = cloud.everything().added;
    index->assign(PointRows(cloud, live, kRadius_m));
    std::set<PointIndex> gone;
    for (PointIndex i = 0; i < cloud.size(); ++i) gone.insert(i);
    for (const PointIndex i : live) gone.erase(i);
    EXPECT_EQ(visit_some(*index, cloud.size(), live), brute_force_without(cloud, gone));
    // It can change as after insertion.
    const std::vector<PointIndex> some(live.begin(), live.begin() + 700);
    index->remove(some);
    index->insert(some);
    EXPECT_EQ(visit_some(*index, cloud.size(), live), brute_force_without(cloud, gone));
  }
  index->assign(PointRows(cloud, {}, kRadius_m));
  index->visit_all([](PointIndex, std::span<const PointIndex>) { ADD_FAILURE(); });
}

TEST_P(NeighbourIndexTest, MayBecomeEmpty) {
  PointCloud cloud;
  cloud.add_slice(0, random_points(300, -0.1, 0.2, 43));
  const auto index = make_neighbour_index(GetParam(), cloud, kRadius_m);
  const std::vector<PointIndex> points = cloud.take_change().added;
  index->insert(points);
  index->remove(points);
  index->visit_all([](PointIndex, std::span<const PointIndex>) { ADD_FAILURE(); });
  index->insert(points);
  EXPECT_EQ(visit_all(*index, cloud.size()), brute_force(cloud, kRadius_m));
}

TEST_P(NeighbourIndexTest, VisitKeepsTheOrderAndTheThread) {
  PointCloud cloud;
  cloud.add_slice(0, random_points(5000, -0.3, 0.6, 44));
  const auto index = make_neighbour_index(GetParam(), cloud, kRadius_m);
  std::vector<PointIndex> points = cloud.take_change().added;
  index->insert(points);
  std::shuffle(points.begin(), points.end(), std::mt19937(3));
  std::vector<PointIndex> visited;
  index->visit(points,
               [&, here = std::this_thread::get_id()](PointIndex i, std::span<const PointIndex>) {
                 EXPECT_EQ(std::this_thread::get_id(), here);
                 visited.push_back(i);
               });
  EXPECT_EQ(visited, points);
}

TEST_P(NeighbourIndexTest, VisitsTheGivenPointsOnly) {
  PointCloud cloud;
  cloud.add_slice(0, random_points(2000, -0.2, 0.4, 31));
  const auto index = make_neighbour_index(GetParam(), cloud, kRadius_m);
  index->insert(cloud.take_change().added);
  Neighbours expected = brute_force(cloud, kRadius_m);
  std::vector<PointIndex> queries;
  for (PointIndex i = 0; i < cloud.size(); ++i) {
    if (i % 3 == 0) {
      queries.push_back(i);
    } else {
      expected[i].clear();
    }
  }
  EXPECT_EQ(visit_some(*index, cloud.size(), queries), expected);
}

INSTANTIATE_TEST_SUITE_P(All, NeighbourIndexTest,
                         testing::Values(NeighbourSearch::kGrid, NeighbourSearch::kFlann),
                         [](const testing::TestParamInfo<NeighbourSearch>& tested) {
                           return tested.param == NeighbourSearch::kGrid ? "Grid" : "Flann";
                         });

}  // namespace
}  // namespace kintsugi::segmenter
