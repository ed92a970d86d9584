#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <oneapi/tbb/global_control.h>

#include "segmenter/core/batch/batch_engine.hpp"
#include "tests/segmenter/core/expect_partition.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::CloudShape;
using testing::literal_batch;
using testing::LiteralParameters;
using testing::random_cloud;

constexpr CloudShape kShapes[] = {CloudShape::kWaves, CloudShape::kLattice, CloudShape::kUnrelated};

TEST(BatchEngine, EmptyCloud) {
  PointCloud cloud;
  BatchEngine engine(cloud, {});
  engine.update(cloud.take_change());
  EXPECT_TRUE(engine.components().empty());
  EXPECT_TRUE(engine.changed().empty());
}

class BatchEngineTest : public ::testing::TestWithParam<NeighbourSearch> {};

TEST_P(BatchEngineTest, EqualsTheLiteralAlgorithms) {
  std::size_t num_segments = 0;
  std::size_t num_points = 0;
  for (const CloudShape shape : kShapes) {
    for (unsigned seed = 0; seed < 30; ++seed) {
      const auto points = random_cloud(shape, 100 + 6 * static_cast<int>(seed), seed);
      PointCloud cloud;
      cloud.add_slice(0, points);
      BatchEngine engine(cloud, {.neighbour_search = GetParam()});
      engine.update(cloud.take_change());
      const auto expected = literal_batch(points, {}, seed);
      testing::expect_partition(engine, expected);
      num_segments += expected.segments.size();
      num_points += points.size();
    }
  }
  // The clouds are worth the test: neither one segment each nor all points alone.
  EXPECT_GT(num_segments, 90U * 4U);
  EXPECT_LT(num_segments, num_points / 2);
}

TEST_P(BatchEngineTest, EqualsTheLiteralAlgorithmsForOtherParameters) {
  const LiteralParameters parameters{.T = 0.01, .k = 0.003, .lambda = 0.02, .r = 0.03F};
  for (unsigned seed = 0; seed < 6; ++seed) {
    auto points = random_cloud(CloudShape::kUnrelated, 200, seed);
    testing::paint_at_random(points, seed);
    PointCloud cloud;
    cloud.add_slice(0, points);
    BatchEngine engine(cloud, {.threshold = parameters.T,
                               .scale = parameters.k,
                               .color_weight = parameters.lambda,
                               .radius_factor = 3.0,
                               .neighbour_search = GetParam()});
    engine.update(cloud.take_change());
    testing::expect_partition(engine, literal_batch(points, parameters));
  }
}

TEST_P(BatchEngineTest, EachUpdateIsAsIfAllPointsCameAtOnce) {
  const auto points = random_cloud(CloudShape::kWaves, 300, 5);
  PointCloud cloud;
  BatchEngine engine(cloud, {.neighbour_search = GetParam()});
  for (int slice = 0; slice < 5; ++slice) {
    cloud.add_slice(slice, std::span(points).subspan(static_cast<std::size_t>(slice) * 60, 60));
    engine.update(cloud.take_change());
    testing::expect_partition(engine, literal_batch(cloud.points_W(), {}));
  }
}

TEST_P(BatchEngineTest, AfterRemovalsAsIfTheOtherPointsWereAll) {
  for (const CloudShape shape : kShapes) {
    PointCloud cloud;
    cloud.add_slice(0, random_cloud(shape, 400, 6));
    BatchEngine engine(cloud, {.neighbour_search = GetParam()});
    engine.update(cloud.take_change());
    std::vector<PointIndex> left = cloud.everything().added;
    std::mt19937 generator(5);
    for (int step = 0; step < 5; ++step) {
      const std::vector<ComponentId> before(engine.components().begin(), engine.components().end());
      CloudChange change;
      std::erase_if(left, [&](PointIndex i) {
        if (generator() % 6 != 0) return false;
        change.removed.push_back(i);
        return true;
      });
      const RunStatistics run = engine.update(change);
      EXPECT_EQ(run.num_points, static_cast<std::int64_t>(left.size()));

      PointCloud remaining;
      std::vector<CloudPoint> points;
      points.reserve(left.size());
      for (const PointIndex i : left) points.push_back(cloud[i]);
      remaining.add_slice(0, points);
      BatchEngine fresh(remaining, {.neighbour_search = GetParam()});
      fresh.update(remaining.take_change());
      std::vector<ComponentId> expected(cloud.size(), kNoComponent);
      std::vector<PointIndex> changed;
      for (PointIndex k = 0; k < left.size(); ++k) {
        const ComponentId component = fresh.components()[k];
        expected[left[k]] = left[component];
        if (before[left[k]] != left[component]) changed.push_back(left[k]);
        EXPECT_EQ(engine.theta(left[component]), fresh.theta(component));
      }
      EXPECT_THAT(engine.components(), ::testing::ElementsAreArray(expected));
      EXPECT_THAT(engine.changed(), ::testing::ElementsAreArray(changed));
    }
  }
}

TEST_P(BatchEngineTest, OrderOfPointsDoesNotMatter) {
  for (const CloudShape shape : kShapes) {
    const auto points = random_cloud(shape, 1500, 3);
    std::vector<PointIndex> order(points.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), std::mt19937(9));
    std::vector<CloudPoint> shuffled;
    shuffled.reserve(points.size());
    for (const PointIndex i : order) shuffled.push_back(points[i]);

    PointCloud cloud;
    PointCloud shuffled_cloud;
    cloud.add_slice(0, points);
    shuffled_cloud.add_slice(0, shuffled);
    BatchEngine engine(cloud, {.neighbour_search = GetParam()});
    BatchEngine shuffled_engine(shuffled_cloud, {.neighbour_search = GetParam()});
    engine.update(cloud.take_change());
    shuffled_engine.update(shuffled_cloud.take_change());

    // Back in the order of `points`, each segment by one of its points.
    std::vector<PointIndex> labels(points.size());
    for (PointIndex k = 0; k < order.size(); ++k) {
      const PointIndex representative = shuffled_engine.components()[k];
      labels[order[k]] = order[representative];
      EXPECT_EQ(shuffled_engine.theta(representative), engine.theta(engine.components()[order[k]]));
    }
    EXPECT_EQ(canonical_labels(labels), canonical_labels(engine.components()));
  }
}

TEST_P(BatchEngineTest, NumberOfThreadsDoesNotMatter) {
  PointCloud cloud;
  cloud.add_slice(0, random_cloud(CloudShape::kLattice, 20000, 4));
  std::vector<std::vector<PointIndex>> results;
  for (const std::size_t num_threads : {1U, 2U, 5U}) {
    using oneapi::tbb::global_control;
    const global_control threads(global_control::max_allowed_parallelism, num_threads);
    BatchEngine engine(cloud, {.neighbour_search = GetParam()});
    engine.update(cloud.everything());
    results.emplace_back(engine.components().begin(), engine.components().end());
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST_P(BatchEngineTest, TellsWhichPointsChanged) {
  const auto points = random_cloud(CloudShape::kWaves, 400, 8);
  PointCloud cloud;
  BatchEngine engine(cloud, {.neighbour_search = GetParam()});
  std::vector<PointIndex> before;
  for (int slice = 0; slice < 8; ++slice) {
    cloud.add_slice(slice, std::span(points).subspan(static_cast<std::size_t>(slice) * 50, 50));
    engine.update(cloud.take_change());
    const std::vector<PointIndex> after(engine.components().begin(), engine.components().end());
    std::vector<PointIndex> expected;
    for (PointIndex i = 0; i < after.size(); ++i) {
      if (i >= before.size() || before[i] != after[i]) expected.push_back(i);
    }
    EXPECT_THAT(engine.changed(), ::testing::ElementsAreArray(expected));
    before = after;
  }
}

INSTANTIATE_TEST_SUITE_P(Searches, BatchEngineTest,
                         ::testing::Values(NeighbourSearch::kGrid, NeighbourSearch::kFlann));

}  // namespace
}  // namespace kintsugi::segmenter
