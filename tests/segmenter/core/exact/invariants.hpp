#pragma once

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "segmenter/core/exact/state.hpp"
#include "tests/segmenter/core/exact/history_check.hpp"
#include "tests/segmenter/core/exact/slow_segmentation.hpp"
#include "tests/segmenter/core/exact/watch_check.hpp"

namespace kintsugi::segmenter::exact::testing {

/// The invariants between two runs, compared with Algorithm 1 over `edges`: all edges below T + k
/// between points in the cloud.
class Invariants {
 public:
  Invariants(const State& state, const JoinRule& rule, const std::set<EdgeKey>& edges)
      : state_(state), rule_(rule), edges_(edges) {}

  void expect() const {
    expect_histories();
    expect_components_at_all_times();
    expect_tree();
    expect_watches();
    expect_nothing_left_of_run();
  }

 private:
  bool is_gone(PointIndex x) const { return state_.vertices[x].is_gone != 0; }
  PointIndex num_vertices() const { return static_cast<PointIndex>(state_.vertices.size()); }

  /// Sizes, ascending keys along hosts, and that the rule allows every join.
  void expect_histories() const {
    const JoinForest& forest = state_.forest;
    for (PointIndex x = 0; x < num_vertices(); ++x) {
      HistoryCheck(state_.vertices, state_.edges, rule_).expect_sound(x);
      EXPECT_EQ(forest.history().first_broken(x), kNone) << "of " << x;
      if (state_.vertices.is_root(x)) {
        EXPECT_EQ(forest.key(x), kNever) << "of root " << x;
        continue;
      }
      EXPECT_FALSE(is_gone(x)) << x << " is gone but absorbed";
      EXPECT_LT(forest.key(x), forest.key(state_.vertices.host(x))) << "of " << x;
      EXPECT_EQ(state_.vertices[x].size, forest.history().total(x)) << "of " << x;
    }
  }

  /// After each join of Algorithm 1: that the forest has it, and the same components then.
  void expect_components_at_all_times() const {
    SlowSegmentation slow(num_vertices(), rule_);
    expect_components(slow, {0, 0, 0});
    for (const EdgeKey& key : edges_) {
      if (slow.take(key)) expect_components(slow, key);
      if (::testing::Test::HasFailure()) return;
    }
    for (PointIndex x = 0; x < num_vertices(); ++x) {
      EXPECT_EQ(state_.forest.history().final_theta(state_.forest.root(x)), slow.theta(x));
    }
  }

  /// Just after `time`.
  void expect_components(const SlowSegmentation& slow, const EdgeKey& time) const {
    const EdgeKey just_after{time.weight_bits, time.a, time.b + 1};
    std::set<PointIndex> representatives;
    for (PointIndex x = 0; x < num_vertices(); ++x) {
      const PointIndex representative = state_.forest.representative_after(x, time);
      EXPECT_TRUE(slow.are_one(x, representative)) << x << " and " << representative;
      const auto component = state_.forest.history().state_before(representative, just_after);
      EXPECT_EQ(component.size, slow.size(x)) << "of " << x;
      EXPECT_EQ(component.weight, slow.weight(x)) << "of " << x;
      if (!representatives.insert(representative).second) continue;
      for (const PointIndex other : representatives) {
        EXPECT_EQ(slow.are_one(representative, other), representative == other)
            << representative << " and " << other;
      }
    }
  }

  /// The joins of Algorithm 1 are the tree edges, each linked at its ends and owned by a guest.
  void expect_tree() const {
    SlowSegmentation slow(num_vertices(), rule_);
    const std::set<EdgeKey> joined = slow.take_all(edges_);
    std::multiset<EdgeKey> linked;
    std::set<EdgeKey> owned;
    for (PointIndex x = 0; x < num_vertices(); ++x) {
      state_.edges.for_each_linked(x, [&](TreeEdgeId edge, PointIndex other) {
        const EdgeKey key = state_.edges.key(edge);
        EXPECT_EQ(key, EdgeKey::of(key.weight(), x, other));
        linked.insert(key);
      });
      if (state_.vertices.is_root(x)) continue;
      owned.insert(state_.forest.key(x));
      EXPECT_EQ(state_.edges.owner(state_.vertices[x].edge), x);
      EXPECT_TRUE(state_.edges.is_linked(state_.vertices[x].edge));
    }
    std::multiset<EdgeKey> twice(joined.begin(), joined.end());
    twice.insert(joined.begin(), joined.end());
    EXPECT_EQ(linked, twice);
    EXPECT_EQ(owned, joined);
  }

  /// Each edge between two segments is watched, by a side that blocks it, in the heap of its root.
  /// An edge inside a segment may still be watched, which has no effect.
  void expect_watches() const {
    SlowSegmentation slow(num_vertices(), rule_);
    slow.take_all(edges_);
    const WatchCheck check(state_.vertices, state_.watches);
    std::multiset<KnownWatch> in_heaps;
    std::multiset<KnownWatch> at_watchers;
    for (PointIndex x = 0; x < num_vertices(); ++x) {
      at_watchers.merge(check.at_watcher(x));
      std::multiset<KnownWatch> heap = check.in_heap_of(x);
      for (const KnownWatch& watch : heap) {
        EXPECT_EQ(state_.forest.root(watch.watcher), x) << "holds a watch at " << watch.watcher;
      }
      in_heaps.merge(heap);
    }
    EXPECT_EQ(in_heaps, at_watchers);
    EXPECT_EQ(in_heaps.size(), state_.watches.size());

    std::set<EdgeKey> watched;
    for (const auto& [key, watcher] : in_heaps) {
      EXPECT_FALSE(slow.is_alive(watcher, key)) << watcher << " watches what it does not block";
      EXPECT_TRUE(edges_.contains(key)) << watcher << " watches what is no edge";
      watched.insert(key);
    }
    for (const EdgeKey& key : edges_) {
      EXPECT_TRUE(slow.are_one(key.a, key.b) || watched.contains(key))
          << "nobody watches the edge between " << key.a << " and " << key.b;
    }
  }

  void expect_nothing_left_of_run() const {
    for (PointIndex x = 0; x < num_vertices(); ++x) {
      const Vertex& v = state_.vertices[x];
      EXPECT_EQ(v.family, 0U) << "of " << x;
      EXPECT_EQ(v.visit, 0U) << "of " << x;
      EXPECT_EQ(v.is_queued, 0U) << "of " << x;
      EXPECT_EQ(v.is_in_queue, 0U) << "of " << x;
      EXPECT_EQ(v.is_heap_open, 0U) << "of " << x;
      EXPECT_EQ(v.is_touched, 0U) << "of " << x;
      if (!is_gone(x)) continue;
      EXPECT_EQ(v.history, kNone) << "of " << x;
      EXPECT_EQ(v.watches, kNone) << "of " << x;
      EXPECT_EQ(v.half_edges, kNone) << "of " << x;
    }
  }

  const State& state_;
  JoinRule rule_;
  const std::set<EdgeKey>& edges_;
};

inline void expect_invariants(const State& state, const JoinRule& rule,
                              const std::set<EdgeKey>& edges) {
  Invariants(state, rule, edges).expect();
}

}  // namespace kintsugi::segmenter::exact::testing
