#include <vector>

#include <gmock/gmock.h>
#include <oneapi/tbb/global_control.h>

#include "segmenter/core/batch/batch_segmentation.hpp"
#include "segmenter/core/graph/build_graph.hpp"
#include "segmenter/core/graph/make_neighbour_index.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::CloudShape;
using testing::random_cloud;

constexpr EngineConfig kConfig{.threshold = 0.001, .scale = 0.0005, .color_weight = 0.003};

struct Told {
  bool is_join;
  Edge edge;
  PointIndex host;
  PointIndex guest;

  bool operator==(const Told&) const = default;
};

class Recorder final : public JoinObserver {
 public:
  void joined(const Edge& edge, PointIndex host, PointIndex guest) override {
    told.push_back({true, edge, host, guest});
  }
  void rejected(const Edge& edge) override { told.push_back({false, edge, 0, 0}); }

  std::vector<Told> told;
};

struct Outcome {
  std::vector<Told> told;
  std::vector<PointIndex> roots;
  std::vector<double> thetas;
  std::int64_t num_joins = 0;

  bool operator==(const Outcome&) const = default;
};

Outcome outcome_of(Recorder&& recorder, SegmentForest& forest, std::int64_t num_joins) {
  Outcome outcome;
  outcome.told = std::move(recorder.told);
  outcome.num_joins = num_joins;
  for (PointIndex i = 0; i < forest.size(); ++i) {
    outcome.roots.push_back(forest.find(i));
    outcome.thetas.push_back(forest.theta_at(outcome.roots.back()));
  }
  return outcome;
}

SegmentForest singletons(PointIndex num_points) {
  SegmentForest forest(kConfig.threshold, kConfig.scale);
  forest.grow(num_points);
  return forest;
}

Outcome in_one_pass(const PointCloud& cloud, const std::vector<PointIndex>& points) {
  const auto index = make_neighbour_index(NeighbourSearch::kGrid, cloud, kConfig.radius_m());
  index->insert(points);
  SegmentForest forest = singletons(cloud.size());
  Recorder recorder;
  const auto num_joins = join_segments(
      build_graph(cloud, *index, kConfig.edge_weight(), kConfig.max_weight()), forest, recorder);
  return outcome_of(std::move(recorder), forest, num_joins);
}

Outcome by_rows(const PointCloud& cloud, const std::vector<PointIndex>& points) {
  SegmentForest forest = singletons(cloud.size());
  Recorder recorder;
  const BatchStatistics statistics = segment_points(cloud, points, kConfig, forest, recorder);
  return outcome_of(std::move(recorder), forest, statistics.num_joins);
}

// Enough points for the search in two passes.
constexpr int kManyPoints = 120'000;

TEST(BatchSegmentation, ManyPointsAsInOnePassOverAllEdges) {
  for (const CloudShape shape : {CloudShape::kWaves, CloudShape::kLattice}) {
    PointCloud cloud;
    cloud.add_slice(0, random_cloud(shape, kManyPoints, 5));
    std::vector<PointIndex> points = cloud.take_change().added;
    std::erase_if(points, [](PointIndex i) { return i % 7 == 0; });
    EXPECT_TRUE(by_rows(cloud, points) == in_one_pass(cloud, points));
  }
}

TEST(BatchSegmentation, AllWeightsZero) {
  PointCloud cloud;
  std::vector<CloudPoint> plane = random_cloud(CloudShape::kLattice, kManyPoints, 5);
  for (CloudPoint& p : plane) {
    p.nx = p.ny = 0.0F;
    p.nz = 1.0F;
  }
  cloud.add_slice(0, plane);
  const std::vector<PointIndex> points = cloud.take_change().added;
  EXPECT_TRUE(by_rows(cloud, points) == in_one_pass(cloud, points));
}

TEST(BatchSegmentation, NoEdges) {
  PointCloud cloud;
  std::vector<CloudPoint> apart = random_cloud(CloudShape::kWaves, kManyPoints, 5);
  for (std::size_t k = 0; k < apart.size(); ++k) apart[k].z = static_cast<float>(k);
  cloud.add_slice(0, apart);
  const std::vector<PointIndex> points = cloud.take_change().added;
  EXPECT_EQ(by_rows(cloud, points).num_joins, 0);
}

TEST(BatchSegmentation, NumberOfThreadsDoesNotMatter) {
  PointCloud cloud;
  cloud.add_slice(0, random_cloud(CloudShape::kWaves, kManyPoints, 5));
  const std::vector<PointIndex> points = cloud.take_change().added;
  using oneapi::tbb::global_control;
  std::vector<Outcome> outcomes;
  for (const std::size_t num_threads : {1U, 3U}) {
    const global_control threads(global_control::max_allowed_parallelism, num_threads);
    outcomes.push_back(by_rows(cloud, points));
  }
  EXPECT_TRUE(outcomes[0] == outcomes[1]);
}

}  // namespace
}  // namespace kintsugi::segmenter
