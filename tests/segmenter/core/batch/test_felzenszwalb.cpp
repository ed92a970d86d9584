#include <algorithm>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/batch/felzenszwalb.hpp"
#include "tests/segmenter/core/literal_segmentation.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::LiteralEdge;
using testing::LiteralPartition;

constexpr double kT = 0.001;
constexpr double kK = 0.0005;

/// A random graph with a weight for each direction; with `num_weights` > 0 only so many different
/// ones, so that many are equal.
std::vector<LiteralEdge> random_graph(int num_points, int num_pairs, int num_weights,
                                      unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto weight = [&] {
    double u = unit(generator);
    if (num_weights > 0) u = std::floor(u * num_weights) / num_weights;
    return static_cast<float>(u * u * 0.006);  // up to four times T + k, half of them less
  };
  std::vector<LiteralEdge> edges;
  for (int e = 0; e < num_pairs; ++e) {
    const int i = static_cast<int>(generator() % static_cast<unsigned>(num_points));
    const int j = (i + 1 + static_cast<int>(generator() % 12U)) % num_points;
    if (i == j) continue;
    edges.push_back({i, j, weight()});
    edges.push_back({j, i, weight()});
  }
  std::shuffle(edges.begin(), edges.end(), generator);
  std::stable_sort(edges.begin(), edges.end(),
                   [](const LiteralEdge& a, const LiteralEdge& b) { return a.w < b.w; });
  return edges;
}

std::vector<Edge> to_edges(const std::vector<LiteralEdge>& directed) {
  std::vector<Edge> edges;
  edges.reserve(directed.size());
  for (const LiteralEdge& e : directed) {
    edges.push_back({e.w, static_cast<PointIndex>(std::min(e.i, e.j)),
                     static_cast<PointIndex>(std::max(e.i, e.j))});
  }
  return edges;
}

/// Keeps the smaller weight of each pair: what the engines store.
std::vector<Edge> undirected(const std::vector<LiteralEdge>& directed) {
  std::vector<Edge> edges = to_edges(directed);
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.i, a.j, a.weight) < std::tie(b.i, b.j, b.weight);
  });
  edges.erase(std::unique(edges.begin(), edges.end(),
                          [](const Edge& a, const Edge& b) { return a.i == b.i && a.j == b.j; }),
              edges.end());
  return edges;
}

SegmentForest segment(const std::vector<Edge>& edges, int num_points) {
  SegmentForest forest(kT, kK);
  forest.grow(static_cast<PointIndex>(num_points));
  join_segments(edges, forest);
  return forest;
}

void expect_same(const SegmentForest& forest, const LiteralPartition& expected) {
  for (const auto& [point, segment] : expected.of) {
    const PointIndex root = forest.root(static_cast<PointIndex>(point));
    EXPECT_EQ(root, forest.root(static_cast<PointIndex>(*segment->d.begin())));
    EXPECT_EQ(forest.theta_at(root), segment->theta);
    EXPECT_TRUE(segment->d.contains(static_cast<int>(root)));
  }
}

struct Case {
  int num_points;
  int num_pairs;
  int num_weights;
};

class Felzenszwalb : public ::testing::TestWithParam<Case> {
 protected:
  static constexpr unsigned kNumSeeds = 60;
  std::vector<LiteralEdge> graph(unsigned seed) const {
    return random_graph(GetParam().num_points, GetParam().num_pairs, GetParam().num_weights, seed);
  }
  LiteralPartition reference(const std::vector<LiteralEdge>& edges) const {
    return testing::literal_segmenter(edges, GetParam().num_points, kT, kK);
  }
};

TEST_P(Felzenszwalb, EqualsTheLiteralAlgorithm) {
  for (unsigned seed = 0; seed < kNumSeeds; ++seed) {
    const auto edges = graph(seed);
    expect_same(segment(to_edges(edges), GetParam().num_points), reference(edges));
  }
}

TEST_P(Felzenszwalb, SmallerDirectionAloneGivesTheSamePartition) {
  for (unsigned seed = 0; seed < kNumSeeds; ++seed) {
    const auto edges = graph(seed);
    expect_same(segment(undirected(edges), GetParam().num_points), reference(edges));
  }
}

TEST_P(Felzenszwalb, EdgesThatCanNeverJoinMayBeLeftOut) {
  for (unsigned seed = 0; seed < kNumSeeds; ++seed) {
    const auto edges = graph(seed);
    std::vector<Edge> pruned = undirected(edges);
    const auto removed = std::erase_if(pruned, [](const Edge& e) { return e.weight >= kT + kK; });
    EXPECT_GT(removed, 0U);
    expect_same(segment(pruned, GetParam().num_points), reference(edges));
  }
}

/// Runs Algorithm 1 on the edges it is called with, one after the other.
struct Retold {
  explicit Retold(int num_points) : forest(kT, kK) {
    forest.grow(static_cast<PointIndex>(num_points));
  }
  void joined(const Edge& edge, PointIndex host, PointIndex guest) {
    expect_ascending(edge);
    EXPECT_THAT((std::vector{forest.find(edge.i), forest.find(edge.j)}),
                ::testing::UnorderedElementsAre(host, guest));
    EXPECT_TRUE(forest.join(edge.i, edge.j, edge.weight));
    EXPECT_EQ(forest.find(guest), host);
    ++num_joined;
  }
  void rejected(const Edge& edge) {
    expect_ascending(edge);
    EXPECT_NE(forest.find(edge.i), forest.find(edge.j));
    EXPECT_FALSE(forest.join(edge.i, edge.j, edge.weight));
    ++num_rejected;
  }
  void expect_ascending(const Edge& edge) {
    EXPECT_FALSE(AscendingWeight()(edge, last));
    last = edge;
  }

  SegmentForest forest;
  Edge last;
  std::int64_t num_joined = 0;
  std::int64_t num_rejected = 0;
};

TEST_P(Felzenszwalb, TellsEachJoinAndEachRejectedEdgeInOrder) {
  for (unsigned seed = 0; seed < kNumSeeds; ++seed) {
    const auto edges = undirected(graph(seed));
    Retold retold(GetParam().num_points);
    SegmentForest forest(kT, kK);
    forest.grow(static_cast<PointIndex>(GetParam().num_points));
    EXPECT_EQ(join_segments(edges, forest, retold), retold.num_joined);
    std::int64_t num_between = 0;
    for (const Edge& edge : edges) num_between += forest.find(edge.i) != forest.find(edge.j);
    EXPECT_GE(retold.num_rejected, num_between);
    for (PointIndex i = 0; i < forest.size(); ++i) {
      EXPECT_EQ(retold.forest.find(i), forest.find(i));
      EXPECT_EQ(retold.forest.theta_at(retold.forest.find(i)), forest.theta_at(forest.find(i)));
    }
  }
}

TEST_P(Felzenszwalb, OrderOfEqualWeightsDoesNotMatter) {
  for (unsigned seed = 0; seed < kNumSeeds; ++seed) {
    auto edges = graph(seed);
    const LiteralPartition expected = reference(edges);
    std::shuffle(edges.begin(), edges.end(), std::mt19937(seed));
    std::stable_sort(edges.begin(), edges.end(),
                     [](const LiteralEdge& a, const LiteralEdge& b) { return a.w < b.w; });
    const LiteralPartition shuffled = reference(edges);
    for (const auto& [point, segment] : expected.of) {
      EXPECT_EQ(shuffled.of.at(point)->d, segment->d);
      EXPECT_EQ(shuffled.of.at(point)->theta, segment->theta);
    }
  }
}

TEST_P(Felzenszwalb, EveryEdgeBetweenTwoSegmentsIsBlockedByAFinalThreshold) {
  int num_between = 0;
  for (unsigned seed = 0; seed < kNumSeeds; ++seed) {
    const auto edges = undirected(graph(seed));
    SegmentForest forest = segment(edges, GetParam().num_points);
    for (const Edge& e : edges) {
      const PointIndex a = forest.find(e.i);
      const PointIndex b = forest.find(e.j);
      EXPECT_LE(forest.theta_at(a), kT + kK);
      if (a == b) continue;
      ++num_between;
      EXPECT_GE(static_cast<double>(e.weight), std::min(forest.theta_at(a), forest.theta_at(b)));
    }
  }
  EXPECT_GT(num_between, 0);
}

INSTANTIATE_TEST_SUITE_P(Graphs, Felzenszwalb,
                         ::testing::Values(Case{40, 60, 0}, Case{40, 200, 0}, Case{120, 300, 0},
                                           Case{40, 60, 30}, Case{40, 200, 12},
                                           Case{120, 300, 20}));

TEST(SegmentForest, ThresholdAfterAJoinIsWeightPlusScaleOverSize) {
  SegmentForest forest(0.5, 0.25);
  forest.grow(3);
  EXPECT_EQ(forest.theta_at(forest.find(2)), 0.5);
  EXPECT_TRUE(forest.join(0, 1, 0.25F));
  EXPECT_EQ(forest.theta_at(forest.find(0)), 0.25 + 0.25 / 2);
  EXPECT_FALSE(forest.join(0, 1, 0.26F)) << "one segment already";
  EXPECT_FALSE(forest.join(1, 2, 0.375F)) << "not below the threshold of {0, 1}";
  EXPECT_TRUE(forest.join(2, 1, 0.3125F));
  EXPECT_EQ(forest.theta_at(forest.find(1)), 0.3125 + 0.25 / 3);
}

TEST(SegmentForest, ResetPointsAreSingletonsAgain) {
  SegmentForest forest(0.5, 0.25);
  forest.grow(4);
  forest.join(0, 1, 0.1F);
  forest.join(2, 3, 0.2F);
  forest.reset(0);
  forest.reset(1);
  EXPECT_NE(forest.find(0), forest.find(1));
  EXPECT_EQ(forest.theta_at(forest.find(0)), 0.5);
  EXPECT_EQ(forest.find(2), forest.find(3));
}

}  // namespace
}  // namespace kintsugi::segmenter
