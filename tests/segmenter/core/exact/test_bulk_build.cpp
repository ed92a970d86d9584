#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/exact/bulk_build.hpp"
#include "tests/fuzz/random.hpp"
#include "tests/fuzz/random_cloud.hpp"
#include "tests/fuzz/weighted_lattice.hpp"
#include "tests/segmenter/core/exact/engine_parts.hpp"
#include "tests/segmenter/core/exact/invariants.hpp"

namespace kintsugi::segmenter::exact {
namespace {

using testing::EngineParts;

/// A state built from scratch over those points of a pool that are wanted.
class Built {
 public:
  template <typename IsWanted>
  Built(const std::vector<CloudPoint>& pool_W, IsWanted&& is_wanted) {
    cloud_.add_slice(0, pool_W);
    state_.vertices.resize(cloud_.size());
    std::vector<PointIndex> points;
    for (PointIndex x = 0; x < cloud_.size(); ++x) {
      if (!is_wanted(x)) continue;
      points.push_back(x);
      state_.vertices.reset(x);
    }
    statistics_ = build_state(PointRows(cloud_, points, EngineParts::kConfig.radius_m()),
                              EngineParts::kConfig, state_);
  }

  const State& state() const { return state_; }
  const BatchStatistics& statistics() const { return statistics_; }

 private:
  PointCloud cloud_;
  State state_{EngineParts::kRule};
  BatchStatistics statistics_;
};

Built build_all(const std::vector<CloudPoint>& pool_W) {
  return {pool_W, [](PointIndex) { return true; }};
}

TEST(BulkBuild, OfNothing) {
  const Built built = build_all({});
  EXPECT_EQ(built.statistics().num_joins, 0);
  testing::expect_invariants(built.state(), EngineParts::kRule, {});
}

TEST(BulkBuild, JoinsOneEdgeAndWatchesAnother) {
  // 0 and 1 freeze at 400 + 250 microunits.
  const Built built = build_all(fuzz::chain_of_weights(std::vector{400e-6, 700e-6}));
  EXPECT_EQ(built.statistics().num_joins, 1);
  const State& state = built.state();
  const PointIndex root = state.forest.root(0);
  EXPECT_EQ(state.forest.root(1), root);
  EXPECT_EQ(state.forest.history().total(root), 2U);
  EXPECT_EQ(state.forest.root(2), 2U);
  EXPECT_EQ(state.watches.top(root).watcher, 1U);
  EXPECT_EQ(state.watches.top(root).other, 2U);
  EXPECT_TRUE(state.watches.empty(2));
}

/// The edges of the tree of a state.
std::set<EdgeKey> tree_of(const State& state) {
  std::set<EdgeKey> tree;
  for (PointIndex x = 0; x < state.vertices.size(); ++x) {
    state.edges.for_each_linked(
        x, [&](TreeEdgeId edge, PointIndex) { tree.insert(state.edges.key(edge)); });
  }
  return tree;
}

/// The edges that made the segment of x, in order.
std::vector<EdgeKey> joins_with(const State& state, PointIndex x) {
  std::vector<EdgeKey> joins;
  const PointIndex root = state.forest.root(x);
  for (PointIndex y = 0; y < state.vertices.size(); ++y) {
    if (y != root && state.forest.root(y) == root) joins.push_back(state.forest.key(y));
  }
  std::sort(joins.begin(), joins.end());
  return joins;
}

TEST(BulkBuild, IsTheStateAfterOneSliceAfterTheOther) {
  fuzz::Random random(1);
  for (int n = 0; n < 60; ++n) {
    const std::vector<CloudPoint> pool_W = fuzz::random_cloud(random, random.between(2, 80), {});
    EngineParts parts(pool_W);
    std::vector<PointIndex> slice;
    for (PointIndex x = 0; x < pool_W.size(); ++x) {
      if (random.chance(0.9)) slice.push_back(x);  // some never come
      const bool is_last = x + 1 == pool_W.size();
      if (is_last || random.chance(0.1)) parts.update(std::exchange(slice, {}), {});
    }
    const Built built(pool_W, [&](PointIndex x) { return parts.is_in(x); });
    const std::set<EdgeKey> edges = parts.edges();
    testing::expect_invariants(built.state(), EngineParts::kRule, edges);
    parts.expect_invariants();
    EXPECT_EQ(tree_of(built.state()), tree_of(parts.state()));
    for (PointIndex x = 0; x < pool_W.size(); ++x) {
      EXPECT_EQ(joins_with(built.state(), x), joins_with(parts.state(), x));
    }
    ASSERT_FALSE(HasFailure()) << "cloud " << n;
  }
}

}  // namespace
}  // namespace kintsugi::segmenter::exact
