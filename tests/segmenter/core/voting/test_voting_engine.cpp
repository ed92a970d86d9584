#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <oneapi/tbb/global_control.h>

#include "segmenter/core/voting/voting_engine.hpp"
#include "tests/segmenter/core/expect_partition.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::CloudShape;
using testing::LiteralParameters;
using testing::LiteralVoting;
using testing::random_cloud;

enum class Arrival {
  kStrips,  ///< as a volume moves along x
  kMixed,   ///< each slice all over the cloud
};

std::vector<CloudPoint> arriving_cloud(CloudShape shape, Arrival arrival, int num_points,
                                       unsigned seed) {
  auto points = random_cloud(shape, num_points, seed);
  if (arrival == Arrival::kStrips) {
    std::stable_sort(points.begin(), points.end(),
                     [](const CloudPoint& a, const CloudPoint& b) { return a.x < b.x; });
  }
  return points;
}

struct Case {
  CloudShape shape;
  Arrival arrival;
  NeighbourSearch search;
};

class VotingEngineTest : public ::testing::TestWithParam<Case> {};

TEST_P(VotingEngineTest, EqualsTheLiteralAlgorithmsAfterEverySlice) {
  constexpr std::size_t kSlicePoints = 45;
  int num_rounds = 0;
  int num_slices = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto points = arriving_cloud(GetParam().shape, GetParam().arrival, 270, seed);
    PointCloud cloud;
    VotingEngine engine(cloud, {.neighbour_search = GetParam().search});
    LiteralVoting literal({});
    for (std::size_t first = 0; first < points.size(); first += kSlicePoints) {
      cloud.add_slice(static_cast<int>(first), std::span(points).subspan(first, kSlicePoints));
      const RunStatistics run = engine.update(cloud.take_change());
      const int rounds = literal.add(cloud.points_W(), seed);
      testing::expect_partition(engine, literal.partition());
      EXPECT_EQ(run.num_iterations, rounds);
      num_rounds += rounds;
      ++num_slices;
    }
  }
  EXPECT_GT(num_rounds, num_slices * 5 / 4) << "hardly anything was voted on";
}

INSTANTIATE_TEST_SUITE_P(
    Clouds, VotingEngineTest,
    ::testing::Values(Case{CloudShape::kWaves, Arrival::kStrips, NeighbourSearch::kGrid},
                      Case{CloudShape::kWaves, Arrival::kMixed, NeighbourSearch::kGrid},
                      Case{CloudShape::kLattice, Arrival::kStrips, NeighbourSearch::kGrid},
                      Case{CloudShape::kLattice, Arrival::kMixed, NeighbourSearch::kGrid},
                      Case{CloudShape::kUnrelated, Arrival::kMixed, NeighbourSearch::kGrid},
                      Case{CloudShape::kWaves, Arrival::kStrips, NeighbourSearch::kFlann}));

TEST(VotingEngine, EqualsTheLiteralAlgorithmsForOtherParameters) {
  for (const double beta : {0.4, 0.85, 0.97}) {
    const LiteralParameters parameters{
        .T = 0.004, .k = 0.002, .lambda = 0.02, .beta = beta, .r = 0.025F};
    for (unsigned seed = 0; seed < 10; ++seed) {
      auto points = arriving_cloud(CloudShape::kUnrelated, Arrival::kMixed, 240, seed);
      testing::paint_at_random(points, seed);
      PointCloud cloud;
      VotingEngine engine(cloud, {.threshold = parameters.T,
                                  .scale = parameters.k,
                                  .color_weight = parameters.lambda,
                                  .beta = parameters.beta,
                                  .radius_factor = 2.5});
      LiteralVoting literal(parameters);
      for (std::size_t first = 0; first < points.size(); first += 40) {
        cloud.add_slice(static_cast<int>(first), std::span(points).subspan(first, 40));
        engine.update(cloud.take_change());
        literal.add(cloud.points_W(), seed);
        testing::expect_partition(engine, literal.partition());
      }
    }
  }
}

TEST(VotingEngine, FirstSliceIsSegmentedAsInBatch) {
  const auto points = random_cloud(CloudShape::kWaves, 250, 2);
  PointCloud cloud;
  cloud.add_slice(0, points);
  VotingEngine engine(cloud, {});
  EXPECT_EQ(engine.update(cloud.take_change()).num_iterations, 1);
  testing::expect_partition(engine, testing::literal_batch(points, {}));
}

TEST(VotingEngine, EmptySliceChangesNothing) {
  PointCloud cloud;
  VotingEngine engine(cloud, {});
  engine.update(cloud.take_change());
  cloud.add_slice(0, random_cloud(CloudShape::kWaves, 100, 2));
  engine.update(cloud.take_change());
  const std::vector<PointIndex> before(engine.components().begin(), engine.components().end());
  cloud.add_slice(1, {});
  EXPECT_EQ(engine.update(cloud.take_change()).num_points, 0);
  EXPECT_THAT(engine.components(), ::testing::ElementsAreArray(before));
  EXPECT_TRUE(engine.changed().empty());
}

/// Every point there is in one component, named by its smallest point; the others in none.
void expect_valid(const VotingEngine& engine, const std::set<PointIndex>& present) {
  const std::span<const ComponentId> components = engine.components();
  for (PointIndex i = 0; i < components.size(); ++i) {
    if (!present.contains(i)) {
      EXPECT_EQ(components[i], kNoComponent);
    } else {
      ASSERT_LE(components[i], i);
      ASSERT_EQ(components[components[i]], components[i]);
      EXPECT_GT(engine.theta(components[i]), 0.0);
    }
  }
}

TEST(VotingEngine, SegmentsWhatIsLeftOfASegmentThatLostPointsAgain) {
  // Two sheets, too far from each other to have a common edge.
  const auto sheet = random_cloud(CloudShape::kWaves, 300, 2);
  std::vector<CloudPoint> points = sheet;
  for (CloudPoint p : sheet) {
    p.z += 1.0F;
    points.push_back(p);
  }
  PointCloud cloud;
  cloud.add_slice(0, points);
  VotingEngine engine(cloud, {});
  engine.update(cloud.take_change());
  CloudChange change;
  for (PointIndex i = 0; i < 150; ++i) change.removed.push_back(i);
  const RunStatistics run = engine.update(change);
  EXPECT_LE(run.num_points, 150);
  const auto upper = testing::literal_batch(sheet, {});
  for (PointIndex i = 0; i < 300; ++i) {
    EXPECT_EQ(engine.components()[300 + i],
              300 + static_cast<PointIndex>(*upper.of.at(static_cast<int>(i))->d.begin()));
  }
}

TEST(VotingEngine, StaysAPartitionWhilePointsComeAndGo) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const auto points = arriving_cloud(CloudShape::kWaves, Arrival::kMixed, 600, seed);
    std::mt19937 generator(seed);
    PointCloud cloud;
    VotingEngine engine(cloud, {});
    std::set<PointIndex> present;
    std::vector<ComponentId> before;
    for (int slice = 0; slice < 10; ++slice) {
      cloud.add_slice(slice, std::span(points).subspan(static_cast<std::size_t>(slice) * 60, 60));
      CloudChange change = cloud.take_change();
      for (const PointIndex i : present) {
        if (generator() % 12 == 0) change.removed.push_back(i);
      }
      engine.update(change);
      for (const PointIndex i : change.removed) present.erase(i);
      present.insert(change.added.begin(), change.added.end());
      expect_valid(engine, present);

      std::vector<PointIndex> changed;
      before.resize(cloud.size(), kNoComponent);
      for (const PointIndex i : present) {
        if (engine.components()[i] != before[i]) changed.push_back(i);
      }
      EXPECT_THAT(engine.changed(), ::testing::ElementsAreArray(changed));
      before.assign(engine.components().begin(), engine.components().end());
    }
  }
}

TEST(VotingEngine, AllPointsMayGo) {
  PointCloud cloud;
  cloud.add_slice(0, random_cloud(CloudShape::kWaves, 200, 3));
  VotingEngine engine(cloud, {});
  engine.update(cloud.take_change());
  CloudChange change;
  change.removed = cloud.everything().added;
  engine.update(change);
  expect_valid(engine, {});
  engine.update(cloud.everything());
  testing::expect_partition(engine, testing::literal_batch(cloud.points_W(), {}));
}

TEST(VotingEngine, TellsWhichPointsChanged) {
  const auto points = arriving_cloud(CloudShape::kWaves, Arrival::kMixed, 600, 8);
  PointCloud cloud;
  VotingEngine engine(cloud, {});
  std::vector<PointIndex> before;
  std::size_t num_renamed = 0;
  for (int slice = 0; slice < 12; ++slice) {
    cloud.add_slice(slice, std::span(points).subspan(static_cast<std::size_t>(slice) * 50, 50));
    engine.update(cloud.take_change());
    const std::vector<PointIndex> after(engine.components().begin(), engine.components().end());
    std::vector<PointIndex> expected;
    for (PointIndex i = 0; i < after.size(); ++i) {
      if (i >= before.size() || before[i] != after[i]) expected.push_back(i);
    }
    EXPECT_THAT(engine.changed(), ::testing::ElementsAreArray(expected));
    num_renamed += expected.size() - 50;
    before = after;
  }
  EXPECT_GT(num_renamed, 0U);
}

TEST(VotingEngine, NumberOfThreadsDoesNotMatter) {
  const auto points = arriving_cloud(CloudShape::kLattice, Arrival::kStrips, 20000, 4);
  std::vector<std::vector<PointIndex>> results;
  for (const std::size_t num_threads : {1U, 5U}) {
    using oneapi::tbb::global_control;
    const global_control threads(global_control::max_allowed_parallelism, num_threads);
    PointCloud cloud;
    VotingEngine engine(cloud, {});
    for (int slice = 0; slice < 4; ++slice) {
      cloud.add_slice(slice,
                      std::span(points).subspan(static_cast<std::size_t>(slice) * 5000, 5000));
      engine.update(cloud.take_change());
    }
    results.emplace_back(engine.components().begin(), engine.components().end());
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(VoteThreshold, RisesFromZeroTowardsOne) {
  EXPECT_EQ(vote_threshold(0.85, 0), 0.0);
  EXPECT_DOUBLE_EQ(vote_threshold(0.85, 1), 0.15);
  EXPECT_DOUBLE_EQ(vote_threshold(0.85, 2), 0.2775);
  EXPECT_LT(vote_threshold(0.85, 50), 1.0);
}

}  // namespace
}  // namespace kintsugi::segmenter
