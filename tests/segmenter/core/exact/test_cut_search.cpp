#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/exact/cut_search.hpp"
#include "tests/fuzz/random.hpp"

namespace kintsugi::segmenter::exact {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;
using ::testing::UnorderedElementsAreArray;
using Points = std::vector<PointIndex>;

/// First the edges of the old tree and the present joins are entered, in any order; then
/// reconcile() is called for each old edge of interest.
class CutSearchTest : public ::testing::Test {
 protected:
  explicit CutSearchTest(PointIndex num_points = 3000) {
    vertices_.resize(num_points);
    for (PointIndex x = 0; x < num_points; ++x) vertices_.reset(x);
  }

  /// Points first, first + 1, ... in a row, joined before and now, by edges of one weight.
  void body(PointIndex first, PointIndex size, float weight) {
    for (PointIndex x = first; x + 1 < first + size; ++x) kept(weight, x, x + 1);
  }
  /// Joined before and now.
  void kept(float weight, PointIndex u, PointIndex v) { told_[EdgeKey::of(weight, u, v)] = {1, 1}; }
  /// Joined before, but not now.
  EdgeKey cut(float weight, PointIndex u, PointIndex v) {
    const EdgeKey key = EdgeKey::of(weight, u, v);
    told_[key] = {1, 0};
    return key;
  }
  /// Joined now, but not before.
  void fresh(float weight, PointIndex u, PointIndex v) {
    told_[EdgeKey::of(weight, u, v)] = {0, 1};
  }

  void set_up() {
    for (const auto& [key, when] : told_) {
      const TreeEdgeId edge = edges_.add(key);
      if (when.then) edges_.link(edge);
      const PointIndex a = forest_.root(key.a);
      const PointIndex b = forest_.root(key.b);
      if (!when.now || a == b) continue;
      const bool is_b_host = forest_.history().total(b) > forest_.history().total(a);
      forest_.absorb(is_b_host ? b : a, is_b_host ? a : b, edge);
    }
  }

  Points reconcile(const EdgeKey& key) { return search_.reconcile(key.a, key.b, key); }
  Points reconcile_reversed(const EdgeKey& key) { return search_.reconcile(key.b, key.a, key); }

  struct When {
    bool then;
    bool now;
  };
  std::map<EdgeKey, When> told_;
  Vertices vertices_;
  TreeEdges edges_{vertices_};
  JoinForest forest_{vertices_, edges_, {.threshold = 1e9, .scale = 1.0}};
  CutSearch search_{vertices_, edges_, forest_};
};

Points range(PointIndex first, PointIndex size) {
  Points points(size);
  std::iota(points.begin(), points.end(), first);
  return points;
}

TEST_F(CutSearchTest, ExploresTheSmallerSide) {
  body(0, 3, 0.1F);
  body(3, 1000, 0.1F);
  const EdgeKey key = cut(0.2F, 2, 500);
  set_up();
  EXPECT_THAT(reconcile(key), UnorderedElementsAreArray(range(0, 3)));
  EXPECT_TRUE(search_.is_explored(1));
  EXPECT_FALSE(search_.is_explored(3));
  EXPECT_THAT(reconcile(key), IsEmpty());  // it is done
}

TEST_F(CutSearchTest, ExploresTheSmallerSideWhicheverEndIsNamedFirst) {
  body(0, 3, 0.1F);
  body(3, 1000, 0.1F);
  const EdgeKey key = cut(0.2F, 2, 500);
  set_up();
  EXPECT_THAT(reconcile_reversed(key), UnorderedElementsAreArray(range(0, 3)));
}

TEST_F(CutSearchTest, ASideIsWhatTheOldTreeConnectsBefore) {
  // The large body joins the single point 0 only after the cut.
  body(10, 1000, 0.1F);
  body(2000, 5, 0.1F);
  kept(0.3F, 0, 10);
  const EdgeKey key = cut(0.2F, 0, 2000);
  set_up();
  EXPECT_THAT(reconcile(key), ElementsAre(0));
}

TEST_F(CutSearchTest, ExploresNothingWhereAReplacementJoinedInTime) {
  body(0, 3, 0.1F);
  body(3, 10, 0.1F);
  fresh(0.15F, 0, 12);
  const EdgeKey key = cut(0.2F, 2, 3);
  set_up();
  EXPECT_THAT(reconcile(key), IsEmpty());
}

TEST_F(CutSearchTest, ExploresNothingWhereTheEdgeItselfJoins) {
  body(0, 3, 0.1F);
  set_up();
  EXPECT_THAT(reconcile(EdgeKey::of(0.1F, 0, 1)), IsEmpty());
  EXPECT_THAT(reconcile(EdgeKey::of(0.1F, 1, 2)), IsEmpty());
}

TEST_F(CutSearchTest, AReplacementThatJoinsLaterComesTooLate) {
  body(0, 3, 0.1F);
  body(3, 10, 0.1F);
  fresh(0.25F, 0, 12);
  const EdgeKey key = cut(0.2F, 2, 3);
  set_up();
  EXPECT_THAT(reconcile(key), UnorderedElementsAre(0, 1, 2));
}

TEST_F(CutSearchTest, AHubThatIsGoneLeavesAllArmsButOneToExplore) {
  const std::vector<PointIndex> sizes = {4, 20, 3, 7};
  std::vector<EdgeKey> spokes;
  PointIndex first = 1;
  for (const PointIndex size : sizes) {
    body(first, size, 0.1F);
    spokes.push_back(cut(0.2F, 0, first));
    first += size;
  }
  set_up();
  search_.set_gone(0);
  EXPECT_THAT(reconcile(spokes[0]), IsEmpty());  // one arm alone has lost nobody
  EXPECT_THAT(reconcile(spokes[1]), UnorderedElementsAreArray(range(1, 4)));
  // The hub and the arms seen so far, of 25 points, are one old component: the arm is smaller.
  EXPECT_THAT(reconcile(spokes[2]), UnorderedElementsAreArray(range(25, 3)));
  EXPECT_THAT(reconcile(spokes[3]), UnorderedElementsAreArray(range(28, 7)));
  for (PointIndex x = 5; x < 25; ++x) EXPECT_FALSE(search_.is_explored(x));
}

TEST_F(CutSearchTest, ArmsThatJoinedInTimeNeedNotBeExplored) {
  std::vector<EdgeKey> spokes;
  for (PointIndex arm = 0; arm < 4; ++arm) {
    body(1 + 10 * arm, 10, 0.1F);
    spokes.push_back(cut(0.2F, 0, 1 + 10 * arm));
  }
  fresh(0.15F, 3, 13);
  fresh(0.16F, 13, 33);
  set_up();
  search_.set_gone(0);
  EXPECT_THAT(reconcile(spokes[0]), IsEmpty());
  EXPECT_THAT(reconcile(spokes[1]), IsEmpty());
  EXPECT_THAT(reconcile(spokes[2]), UnorderedElementsAreArray(range(21, 10)));
  EXPECT_THAT(reconcile(spokes[3]), IsEmpty());
}

TEST_F(CutSearchTest, PointsThatAreGoneTogetherLeaveNothingToExplore) {
  const EdgeKey first = cut(0.1F, 0, 1);
  const EdgeKey second = cut(0.2F, 1, 2);
  const EdgeKey third = cut(0.3F, 2, 3);
  set_up();
  for (const PointIndex x : {0U, 1U, 2U}) search_.set_gone(x);
  EXPECT_THAT(reconcile(first), IsEmpty());
  EXPECT_THAT(reconcile(second), IsEmpty());
  EXPECT_THAT(reconcile(third), IsEmpty());
  EXPECT_FALSE(search_.is_explored(3));
}

TEST_F(CutSearchTest, FindsTheMainPointThroughFamilies) {
  // Bodies of 2, 5, 15, 40 points, each hanging on the smaller ones by an edge that is cut now.
  body(0, 2, 0.1F);
  body(2, 5, 0.1F);
  body(7, 15, 0.1F);
  body(22, 40, 0.1F);
  const EdgeKey first = cut(0.2F, 1, 2);
  const EdgeKey second = cut(0.3F, 0, 7);  // from the body that is explored by then
  const EdgeKey third = cut(0.4F, 1, 22);
  const EdgeKey fourth = cut(0.5F, 0, 100);  // a point alone, that is with all of them now
  fresh(0.45F, 100, 61);
  const EdgeKey fifth = cut(0.6F, 3, 200);  // and one that is not
  set_up();
  EXPECT_THAT(reconcile(first), UnorderedElementsAreArray(range(0, 2)));
  EXPECT_THAT(reconcile(second), UnorderedElementsAreArray(range(2, 5)));
  EXPECT_THAT(reconcile(third), UnorderedElementsAreArray(range(7, 15)));
  EXPECT_THAT(reconcile(fourth), IsEmpty());
  EXPECT_THAT(reconcile(fifth), ElementsAre(200));
  EXPECT_EQ(search_.num_explored(), 2 + 5 + 15 + 1);
}

TEST_F(CutSearchTest, TheFutureOfARepresentativeCosts) {
  // Point 0 alone is to absorb 800 points one by one: to undo that costs more than ten points. Its
  // own edges are few.
  for (PointIndex x = 0; x < 800; ++x) kept(0.3F + 1e-4F * static_cast<float>(x), x, x + 1);
  body(1000, 10, 0.1F);
  const EdgeKey key = cut(0.2F, 0, 1000);
  set_up();
  EXPECT_THAT(reconcile(key), UnorderedElementsAreArray(range(1000, 10)));
}

TEST_F(CutSearchTest, WhatIsExploredIsForgottenAfterTheRun) {
  body(0, 3, 0.1F);
  body(3, 10, 0.1F);
  const EdgeKey key = cut(0.2F, 2, 3);
  set_up();
  search_.set_gone(20);
  const Points explored = reconcile(key);
  search_.finish();
  EXPECT_EQ(search_.num_explored(), 0);
  for (PointIndex x = 0; x < 30; ++x) {
    EXPECT_EQ(vertices_[x].family, 0U);
    EXPECT_EQ(vertices_[x].visit, 0U);
  }
  EXPECT_THAT(reconcile(key), UnorderedElementsAreArray(explored));
}

/// Old trees and joins at random. The invariant that the header states, checked for the old
/// components of all times.
class CutSearchInvariant : public CutSearchTest {
 protected:
  static constexpr PointIndex kNumPoints = 40;

  CutSearchInvariant() : CutSearchTest(kNumPoints) {}

  PointIndex random_point() { return static_cast<PointIndex>(random_.below(kNumPoints)); }

  void tell(std::size_t num_gone) {
    while (gone_.size() < num_gone) gone_.insert(random_point());
    std::vector<PointIndex> old_component(kNumPoints);
    std::iota(old_component.begin(), old_component.end(), 0);
    const auto is_kept = [&](PointIndex u, PointIndex v) {
      return !gone_.contains(u) && !gone_.contains(v) && random_.chance(0.8);
    };
    for (int time = 1; time < 80; ++time) {
      const auto weight = 0.01F * static_cast<float>(time);
      const PointIndex u = random_point();
      const PointIndex v = random_point();
      if (old_component[u] != old_component[v]) {
        is_kept(u, v) ? kept(weight, u, v) : static_cast<void>(cut(weight, u, v));
        std::replace(old_component.begin(), old_component.end(), PointIndex{old_component[u]},
                     old_component[v]);
      } else if (u != v && is_kept(u, v)) {
        fresh(weight, u, v);
      }
    }
  }

  void reconcile_all() {
    for (const auto& [key, when] : told_) {
      if (!when.then) continue;
      for (const PointIndex x : reconcile(key)) {
        EXPECT_FALSE(gone_.contains(x)) << x << " is gone but explored";
        EXPECT_TRUE(explored_.insert(x).second) << x << " is explored twice";
      }
      expect_invariant(key);
    }
  }

  /// At `time` and before, the points of each old component that are not explored are in one.
  void expect_invariant(const EdgeKey& time) {
    std::vector<PointIndex> old_component(kNumPoints);
    std::iota(old_component.begin(), old_component.end(), 0);
    for (const auto& [key, when] : told_) {
      if (time < key) return;
      if (!when.then) continue;
      std::replace(old_component.begin(), old_component.end(), PointIndex{old_component[key.a]},
                   old_component[key.b]);
      std::map<PointIndex, PointIndex> now;
      for (PointIndex x = 0; x < kNumPoints; ++x) {
        if (gone_.contains(x) || explored_.contains(x)) continue;
        const PointIndex component = forest_.representative_after(x, key);
        ASSERT_EQ(now.try_emplace(old_component[x], component).first->second, component);
      }
    }
  }

  fuzz::Random random_{1};
  std::set<PointIndex> gone_;
  std::set<PointIndex> explored_;
};

class CutSearchInvariantSeeds : public CutSearchInvariant,
                                public ::testing::WithParamInterface<std::uint64_t> {};

TEST_P(CutSearchInvariantSeeds, Holds) {
  random_ = fuzz::Random(GetParam());
  tell(GetParam() % 6);
  set_up();
  for (const PointIndex x : gone_) search_.set_gone(x);
  reconcile_all();
}

INSTANTIATE_TEST_SUITE_P(Seeds, CutSearchInvariantSeeds, ::testing::Range<std::uint64_t>(0, 200));

}  // namespace
}  // namespace kintsugi::segmenter::exact
