#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/exact/join_forest.hpp"
#include "tests/fuzz/random.hpp"
#include "tests/segmenter/core/exact/history_check.hpp"

namespace kintsugi::segmenter::exact {
namespace {

constexpr JoinRule kRule{.threshold = 0.001, .scale = 0.0005};

/// Components by the list of joins, each between one point of either side.
class Components {
 public:
  explicit Components(PointIndex num_points) : labels_(num_points), weights_(num_points, 0.0F) {
    std::iota(labels_.begin(), labels_.end(), 0);
  }

  void join(const EdgeKey& key) {
    const PointIndex kept = labels_[key.a];
    std::replace(labels_.begin(), labels_.end(), PointIndex{labels_[key.b]}, kept);
    weights_[kept] = key.weight();
  }
  bool are_one(PointIndex x, PointIndex y) const { return labels_[x] == labels_[y]; }
  std::uint32_t size(PointIndex x) const {
    return static_cast<std::uint32_t>(std::count(labels_.begin(), labels_.end(), labels_[x]));
  }
  double theta(PointIndex x) const { return kRule.theta(weights_[labels_[x]], size(x)); }

 private:
  std::vector<PointIndex> labels_;
  std::vector<float> weights_;  ///< by label
};

class JoinForestTest : public ::testing::Test {
 protected:
  static constexpr PointIndex kNumPoints = 40;

  JoinForestTest() {
    vertices_.resize(kNumPoints);
    for (PointIndex x = 0; x < kNumPoints; ++x) vertices_.reset(x);
  }

  /// Joins the components of a and b, of which the one of a is the host.
  TreeEdgeId join(float weight, PointIndex a, PointIndex b) {
    const EdgeKey key = EdgeKey::of(weight, a, b);
    const TreeEdgeId edge = edges_.add(key);
    forest_.absorb(forest_.root(a), forest_.root(b), edge);
    joins_.insert(key);
    return edge;
  }

  /// Joins at random, in ascending order, until `num_components` are left.
  void join_at_random(PointIndex num_components, std::size_t num_weights) {
    std::multiset<float> weights;
    while (weights.size() + num_components < kNumPoints) {
      weights.insert(1e-3F * static_cast<float>(random_.below(num_weights)) /
                     static_cast<float>(num_weights));
    }
    EdgeKey last{0, 0, 0};
    for (const float weight : weights) {
      const EdgeKey key = next_key(weight, last);
      if (key == kNever) continue;  // none left of this weight
      join(weight, key.a, key.b);
      last = key;
    }
  }

  /// A key after `last` between two components; kNever when none is found.
  EdgeKey next_key(float weight, const EdgeKey& last) {
    for (int attempt = 0; attempt < 50; ++attempt) {
      auto a = static_cast<PointIndex>(random_.below(kNumPoints));
      auto b = static_cast<PointIndex>(random_.below(kNumPoints));
      if (is_between_roots_) a = forest_.root(a);
      if (is_between_roots_) b = forest_.root(b);
      const EdgeKey key = EdgeKey::of(weight, a, b);
      if (forest_.root(a) != forest_.root(b) && last < key) return key;
    }
    return kNever;
  }

  Components components_before(const EdgeKey& time) const {
    Components components(kNumPoints);
    for (const EdgeKey& key : joins_) {
      if (key < time) components.join(key);
    }
    return components;
  }

  /// Just before `time`.
  void expect_components(const EdgeKey& time) const {
    const Components components = components_before(time);
    for (PointIndex x = 0; x < kNumPoints; ++x) {
      const PointIndex representative = forest_.representative_before(x, time);
      const double theta = components.theta(x);
      ASSERT_TRUE(components.are_one(x, representative));
      ASSERT_EQ(forest_.history().state_before(representative, time).size, components.size(x));
      ASSERT_EQ(forest_.is_alive(representative, time), time.weight() < theta);
      for (PointIndex y = 0; y < x; ++y) {
        ASSERT_EQ(components.are_one(x, y),
                  forest_.representative_before(y, time) == representative);
      }
    }
  }

  /// Before and after each join, and at the end.
  void expect_all_components() const {
    for (const EdgeKey& key : joins_) {
      expect_components(key);
      const EdgeKey just_after{key.weight_bits, key.a, key.b + 1};
      expect_components(just_after);
      for (PointIndex x = 0; x < kNumPoints; ++x) {
        ASSERT_EQ(forest_.representative_after(x, key),
                  forest_.representative_before(x, just_after));
        ASSERT_EQ(forest_.is_absorbed_before(x, key), forest_.key(x) < key);
        ASSERT_EQ(forest_.is_absorbed_up_to(x, key), !(key < forest_.key(x)));
      }
    }
    const Components components = components_before(kNever);
    for (PointIndex x = 0; x < kNumPoints; ++x) {
      ASSERT_EQ(forest_.root(x), forest_.representative_before(x, kNever));
      ASSERT_EQ(forest_.history().total(forest_.root(x)), components.size(x));
      ASSERT_EQ(forest_.history().final_theta(forest_.root(x)), components.theta(x));
    }
    expect_sound();
  }

  void expect_sound() const {
    for (PointIndex x = 0; x < kNumPoints; ++x) {
      testing::HistoryCheck(vertices_, edges_, kRule).expect_sound(x);
      ASSERT_EQ(forest_.key(x) == kNever, vertices_.is_root(x));
      if (vertices_.is_root(x)) continue;
      ASSERT_LT(forest_.key(x), forest_.key(vertices_.host(x)));  // ascends along hosts
      ASSERT_EQ(vertices_[x].size, forest_.history().total(x));
      ASSERT_EQ(edges_.owner(vertices_[x].edge), x);
    }
  }

  /// All points are in the cloud, each a component of its own.
  void release_everything() {
    for (PointIndex x = 0; x < kNumPoints; ++x) {
      if (!vertices_.is_root(x)) forest_.release(x);
      vertices_[x].is_gone = 0;
    }
    joins_.clear();
  }

  /// Updates the sizes of all hosts above x, as a run does.
  void recount_above(PointIndex x) {
    for (; !vertices_.is_root(x); x = vertices_.host(x)) forest_.recount(x);
  }

  /// The ends of edges are representatives, so that each join stays one when another is released.
  bool is_between_roots_ = false;
  fuzz::Random random_{1};
  Vertices vertices_;
  TreeEdges edges_{vertices_};
  JoinForest forest_{vertices_, edges_, kRule};
  std::set<EdgeKey> joins_;
};

TEST_F(JoinForestTest, KnowsWhoStoodForWhomAtAnyTime) {
  join(0.1F, 0, 1);
  join(0.2F, 2, 3);
  join(0.3F, 2, 0);
  EXPECT_EQ(forest_.representative_before(1, EdgeKey::of(0.1F, 0, 1)), 1U);
  EXPECT_EQ(forest_.representative_after(1, EdgeKey::of(0.1F, 0, 1)), 0U);
  EXPECT_EQ(forest_.representative_before(1, EdgeKey::of(0.3F, 0, 2)), 0U);
  EXPECT_EQ(forest_.representative_after(1, EdgeKey::of(0.3F, 0, 2)), 2U);
  EXPECT_EQ(forest_.key(0), EdgeKey::of(0.3F, 0, 2));
  EXPECT_EQ(forest_.key(2), kNever);
  expect_all_components();
}

TEST_F(JoinForestTest, AliveIsStrictlyBelowTheta) {
  // k / 8 is exact beside a weight of 0; T is between two floats.
  for (PointIndex x = 1; x < 8; ++x) join(0.0F, 0, x);
  const auto theta = static_cast<float>(kRule.scale / 8.0);
  EXPECT_EQ(forest_.is_alive(0, EdgeKey::of(theta, 0, 9)), theta < kRule.scale / 8.0);
  EXPECT_TRUE(forest_.is_alive(0, EdgeKey::of(std::nextafter(theta, 0.0F), 0, 9)));
  EXPECT_FALSE(forest_.is_alive(0, EdgeKey::of(std::nextafter(theta, 1.0F), 0, 9)));
  EXPECT_FALSE(forest_.is_alive(9, EdgeKey::of(0.001F, 0, 9)));
  EXPECT_TRUE(forest_.is_alive(9, EdgeKey::of(0.0009F, 0, 9)));
}

TEST_F(JoinForestTest, MakesAListOfJoins) {
  for (const std::size_t num_weights : {3, 20, 1'000'000}) {
    join_at_random(4, num_weights);
    expect_all_components();
    if (HasFatalFailure()) return;
    release_everything();
  }
}

TEST_F(JoinForestTest, ReleaseTakesBackOneJoin) {
  is_between_roots_ = true;
  join_at_random(3, 10);
  for (int n = 0; n < 20; ++n) {
    const auto guest = static_cast<PointIndex>(random_.below(kNumPoints));
    if (vertices_.is_root(guest)) continue;
    const TreeEdgeId edge = vertices_[guest].edge;
    const PointIndex host = vertices_.host(guest);
    EXPECT_EQ(forest_.release(guest), host);
    EXPECT_EQ(edges_.owner(edge), kNone);
    joins_.erase(edges_.key(edge));
    recount_above(host);
    expect_all_components();
    if (HasFatalFailure()) return;
  }
}

TEST_F(JoinForestTest, ReleaseAfterTakesBackTheFuture) {
  is_between_roots_ = true;
  for (int n = 0; n < 40; ++n) {
    join_at_random(3, 10);
    const EdgeKey time =
        *std::next(joins_.begin(), static_cast<std::ptrdiff_t>(random_.below(joins_.size())));
    const auto x = static_cast<PointIndex>(random_.below(kNumPoints));
    std::vector<PointIndex> later;
    forest_.history().for_each_guest(x, [&](PointIndex child) {
      if (time < forest_.key(child)) later.push_back(child);
    });
    std::vector<JoinForest::Freed> freed;
    forest_.release_after(x, time, freed);
    ASSERT_EQ(freed.size(), later.size());
    for (std::size_t k = 0; k < freed.size(); ++k) {
      EXPECT_EQ(freed[k].guest, later[k]);
      EXPECT_EQ(edges_.owner(freed[k].edge), kNone);
      joins_.erase(edges_.key(freed[k].edge));
    }
    recount_above(x);
    expect_all_components();
    if (HasFatalFailure()) return;
    release_everything();
  }
}

TEST_F(JoinForestTest, RecountTellsWhetherThereIsAChange) {
  join(0.1F, 1, 2);
  join(0.3F, 0, 1);
  EXPECT_FALSE(forest_.recount(1));
  forest_.release(2);
  EXPECT_EQ(forest_.history().total(0), 3U);
  EXPECT_TRUE(forest_.recount(1));
  EXPECT_EQ(forest_.history().total(0), 2U);
  EXPECT_FALSE(forest_.recount(1));
}

TEST_F(JoinForestTest, StepDownIsTakenOverByTheFirstGuestThatStays) {
  join(0.1F, 0, 1);
  join(0.2F, 0, 2);
  join(0.3F, 0, 3);
  join(0.4F, 4, 0);
  vertices_[0].is_gone = vertices_[1].is_gone = 1;
  EXPECT_EQ(forest_.step_down(0), 2U);
  EXPECT_EQ(vertices_.host(0), 2U);
  EXPECT_EQ(vertices_.host(1), 0U);
  EXPECT_EQ(vertices_.host(3), 2U);
  EXPECT_EQ(vertices_.host(2), 4U);
  EXPECT_EQ(forest_.key(2), EdgeKey::of(0.4F, 0, 4));
  expect_all_components();
}

TEST_F(JoinForestTest, StepDownOfAPointWithoutHeirs) {
  join(0.1F, 0, 1);
  vertices_[0].is_gone = vertices_[1].is_gone = 1;
  EXPECT_EQ(forest_.step_down(1), kNone);
  EXPECT_EQ(forest_.step_down(0), kNone);
  EXPECT_EQ(vertices_.host(1), 0U);
  expect_all_components();
}

TEST_F(JoinForestTest, StepDownKeepsTheComponentsOfAllTimes) {
  for (int n = 0; n < 40; ++n) {
    join_at_random(static_cast<PointIndex>(random_.between(1, 5)), n % 2 == 0 ? 5 : 1'000'000);
    std::vector<PointIndex> leaving;
    while (leaving.size() < 8) {
      leaving.push_back(static_cast<PointIndex>(random_.below(kNumPoints)));
      vertices_[leaving.back()].is_gone = 1;
    }
    for (const PointIndex x : leaving) {
      forest_.step_down(x);
      forest_.history().for_each_guest(
          x, [&](PointIndex child) { EXPECT_TRUE(vertices_[child].is_gone) << "of " << x; });
    }
    expect_all_components();
    if (HasFailure()) return;
    release_everything();
  }
}

}  // namespace
}  // namespace kintsugi::segmenter::exact
