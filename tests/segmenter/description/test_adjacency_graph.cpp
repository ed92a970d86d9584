// Which segments touch, against looking at every pair of points; and descriptions that use it.

#include <algorithm>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <oneapi/tbb/global_control.h>

#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/description/segment_description.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/map/segment_map.hpp"
#include "tests/segmenter/process/slice_session.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::CloudShape;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::make_point;
using testing::random_cloud;
using testing::wavy_session;

AdjacencyGraph slow_graph(const LabelledCloud& cloud) {
  AdjacencyGraph graph;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> counts;
  for (std::size_t i = 0; i < cloud.points_W.size(); ++i) {
    const std::uint32_t a = cloud.segment_ids[i];
    if (a == kNoSegment) continue;
    graph.segment_ids.push_back(a);
    for (std::size_t j = 0; j < i; ++j) {
      const std::uint32_t b = cloud.segment_ids[j];
      if (b == kNoSegment || a == b) continue;
      if (are_neighbours(cloud.points_W[i], cloud.points_W[j], cloud.radius_m)) {
        ++counts[std::minmax(a, b)];
      }
    }
  }
  std::sort(graph.segment_ids.begin(), graph.segment_ids.end());
  graph.segment_ids.erase(std::unique(graph.segment_ids.begin(), graph.segment_ids.end()),
                          graph.segment_ids.end());
  for (const auto& [pair, count] : counts) {
    graph.edges.push_back({pair.first, pair.second, count});
  }
  return graph;
}

struct RandomCloud {
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> segment_ids;

  /// Ids as large as can be among them, and points without.
  RandomCloud(CloudShape shape, int num_points, unsigned seed)
      : points_W(random_cloud(shape, num_points, seed)) {
    const std::vector<std::uint32_t> ids = {kNoSegment, 1, 2, 3, 70'000, UINT32_MAX};
    std::mt19937 random(seed);
    for (const CloudPoint& point : points_W) {  // stripes with ragged edges
      const auto stripe = static_cast<std::size_t>(std::max(0.0F, point.x) / 0.03F);
      segment_ids.push_back(ids[(stripe + (random() % 4 == 0 ? 1 : 0)) % ids.size()]);
    }
  }
  LabelledCloud view() const { return {points_W, segment_ids, 0.01F, 0.02F}; }
};

TEST(AdjacencyGraph, EqualsLookingAtEveryPair) {
  unsigned seed = 0;
  for (const CloudShape shape :
       {CloudShape::kWaves, CloudShape::kLattice, CloudShape::kUnrelated}) {
    for (const int num_points : {1, 40, 900}) {
      const RandomCloud cloud(shape, num_points, ++seed);
      const AdjacencyGraph graph = adjacency_graph(cloud.view());
      EXPECT_EQ(graph, slow_graph(cloud.view()));
      EXPECT_EQ(graph.edges.empty(), num_points == 1);
    }
  }
}

TEST(AdjacencyGraph, IsTheSameWithOneThread) {
  const RandomCloud cloud(CloudShape::kWaves, 5000, 4);
  const AdjacencyGraph graph = adjacency_graph(cloud.view());
  const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(adjacency_graph(cloud.view()), graph);
}

TEST(AdjacencyGraph, SegmentsAtTheRadiusExactlyDoNotTouch) {
  const std::vector<CloudPoint> points = {make_point(0, 0, 0, 0, 0, 1),
                                          make_point(0.5, 0, 0, 0, 0, 1),
                                          make_point(0.9375, 0, 0, 0, 0, 1)};
  const std::vector<std::uint32_t> ids = {7, 3, 5};
  const AdjacencyGraph graph = adjacency_graph({points, ids, 0.25F, 0.5F});
  EXPECT_THAT(graph.segment_ids, ElementsAre(3, 5, 7));
  EXPECT_THAT(graph.edges, ElementsAre(AdjacencyEdge{3, 5, 1}));
}

TEST(AdjacencyGraph, OfNoPointsIsEmpty) {
  const std::vector<CloudPoint> points(2);
  const std::vector<std::uint32_t> ids = {kNoSegment, kNoSegment};
  EXPECT_EQ(adjacency_graph({points, ids, 0.01F, 0.02F}), AdjacencyGraph{});
  EXPECT_EQ(adjacency_graph({{}, {}, 0.01F, 0.02F}), AdjacencyGraph{});
}

/// A map with corrections: places of points that are gone, points that were rejected.
std::unique_ptr<SegmentMap> corrected_map() {
  auto slices = wavy_session(8, 300);
  slices[3].points_W[5].x = NAN;
  SegmentMapConfig config;
  auto map = std::make_unique<SegmentMap>(config, 99, slices[0]);
  for (const CloudSlice& slice : slices) map->add({&slice, 1});
  slices[2].revision = 1;
  slices[2].points_W.resize(250);
  for (CloudPoint& point : slices[2].points_W) point.z += 0.002F;
  map->add({&slices[2], 1});
  return map;
}

void expect_same(const SegmentDescription& a, const SegmentDescription& b) {
  EXPECT_EQ(a.statistics, b.statistics);
  EXPECT_EQ(a.last_change, b.last_change);
  EXPECT_EQ(a.neighbours, b.neighbours);
  EXPECT_EQ(a.shape.is_planar, b.shape.is_planar);
  EXPECT_EQ(a.shape.box.X_WB.matrix(), b.shape.box.X_WB.matrix());
  EXPECT_EQ(a.shape.box.size_m, b.shape.box.size_m);
  EXPECT_EQ(a.shape.plane.offset_m, b.shape.plane.offset_m);
  EXPECT_EQ(a.shape.plane.rms_m, b.shape.plane.rms_m);
}

TEST(SegmentDescription, OneAndAllLiveAndCopiedAgree) {
  const auto map = corrected_map();
  const MapSnapshot snapshot = take_snapshot(*map);
  const std::vector<SegmentDescription> all = describe_segments(snapshot);
  ASSERT_EQ(std::ssize(all), map->segment_ids().num_segments());
  ASSERT_GT(all.size(), 10U);
  const AdjacencyGraph graph = slow_graph(labelled_cloud(*map));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::uint32_t id = all[i].statistics.segment_id;
    EXPECT_EQ(all[i].statistics, map->statistics().all()[i]);
    EXPECT_EQ(all[i].last_change, map->statistics().last_change(id));
    std::vector<SegmentNeighbour> neighbours;
    for (const AdjacencyEdge& edge : graph.edges) {
      if (edge.b == id) neighbours.push_back({edge.a, edge.num_pairs});
    }
    for (const AdjacencyEdge& edge : graph.edges) {
      if (edge.a == id) neighbours.push_back({edge.b, edge.num_pairs});
    }
    EXPECT_EQ(all[i].neighbours, neighbours);
    expect_same(describe_segment(snapshot, id).value(), all[i]);
    expect_same(describe_segment(*map, id).value(), all[i]);
  }
}

TEST(SegmentDescription, OfAnUnknownSegmentIsNothing) {
  const auto map = corrected_map();
  const MapSnapshot snapshot = take_snapshot(*map);
  for (const std::uint32_t id : {kNoSegment, map->segment_ids().next_id(), UINT32_MAX}) {
    EXPECT_FALSE(describe_segment(*map, id).has_value());
    EXPECT_FALSE(describe_segment(snapshot, id).has_value());
  }
}

TEST(SegmentDescription, OfAnEmptyMapThereAreNone) {
  auto slices = wavy_session(1, 0);
  SegmentMap map({}, 99, slices[0]);
  map.add(slices);
  EXPECT_THAT(describe_segments(take_snapshot(map)), IsEmpty());
}

}  // namespace
}  // namespace kintsugi::segmenter
