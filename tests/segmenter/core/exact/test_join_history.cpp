#include <algorithm>
#include <iterator>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/exact/join_history.hpp"
#include "tests/fuzz/random.hpp"
#include "tests/segmenter/core/exact/history_check.hpp"

namespace kintsugi::segmenter::exact {
namespace {

constexpr JoinRule kRule{.threshold = 0.001, .scale = 0.0005};
constexpr double kHeaviest = 0.0014;  // nearly T + k

/// One join of a host, in a plain sorted list.
struct Join {
  EdgeKey key;
  PointIndex child;
  std::uint32_t size;
};
using Joins = std::vector<Join>;

/// Hosts 0 .. kNumHosts - 1 that absorb the vertices after them, in the vertices and in lists.
class Histories {
 public:
  static constexpr PointIndex kNumHosts = 4;

  explicit Histories(PointIndex num_children) : joins_(kNumHosts), ends_(kNumHosts, kNever) {
    vertices_.resize(kNumHosts + num_children);
    for (PointIndex x = 0; x < vertices_.size(); ++x) vertices_.reset(x);
    for (PointIndex x = kNumHosts; x < vertices_.size(); ++x) free_.push_back(x);
  }

  Joins& joins(PointIndex host) { return joins_[host]; }
  JoinHistory& history() { return history_; }
  bool has_free() const { return !free_.empty(); }

  /// Sets the absorption of a free child, which is in no history yet.
  Join new_join(PointIndex host, float weight, std::uint32_t size) {
    const PointIndex child = free_.back();
    free_.pop_back();
    const Join join{EdgeKey::of(weight, host, child), child, size};
    vertices_.set_absorbed(child, host, edges_.add(join.key), join.key.weight_bits);
    vertices_[child].size = size;
    return join;
  }

  void insert(PointIndex host, float weight, std::uint32_t size) {
    const Join join = new_join(host, weight, size);
    history_.insert(join.child);
    Joins& joins = joins_[host];
    joins.insert(first_after(host, join.key), join);
  }

  void erase(PointIndex host, std::size_t k) {
    const PointIndex child = joins_[host][k].child;
    history_.erase(child);
    set_free(child);
    joins_[host].erase(joins_[host].begin() + static_cast<std::ptrdiff_t>(k));
  }

  void update_size(PointIndex host, std::size_t k, std::uint32_t size) {
    Join& join = joins_[host][k];
    vertices_[join.child].size = join.size = size;
    history_.update_size(join.child);
  }

  void split_after(PointIndex host, const EdgeKey& time) {
    std::vector<PointIndex> out{kNone};  // it appends
    history_.split_after(host, time, out);
    std::vector<PointIndex> expected{kNone};
    Joins& joins = joins_[host];
    const auto first = first_after(host, time);
    for (auto join = first; join != joins.end(); ++join) expected.push_back(join->child);
    joins.erase(first, joins.end());
    EXPECT_EQ(out, expected);
    for (std::size_t k = 1; k < out.size(); ++k) set_free(out[k]);
  }

  /// Moves the guests of `from` after `time` to `to`, which has none after it.
  void hand_over(PointIndex from, PointIndex to, const EdgeKey& time) {
    split_after(to, time);
    const PointIndex taken = history_.take_after(from, time);
    const auto first = first_after(from, time);
    EXPECT_EQ(taken == kNone, first == joins_[from].end());
    expect_sound(from, {joins_[from].begin(), first});
    history_.append(to, taken);
    joins_[to].insert(joins_[to].end(), first, joins_[from].end());
    joins_[from].erase(first, joins_[from].end());
  }

  /// Replaces the whole history of `host`.
  void build(PointIndex host, Joins joins) {
    split_after(host, EdgeKey{0, 0, 0});
    std::sort(joins.begin(), joins.end(),
              [](const Join& x, const Join& y) { return x.key < y.key; });
    std::vector<PointIndex> children;
    for (const Join& join : joins) children.push_back(join.child);
    history_.build(host, children);
    joins_[host] = std::move(joins);
  }

  /// `host` itself is absorbed at `weight`, or free.
  void set_end(PointIndex host, float weight) {
    ends_[host] = EdgeKey::of(weight, host, host + 1);
    const TreeEdgeId edge = edges_.add(ends_[host]);
    vertices_.set_absorbed(host, (host + 1) % kNumHosts, edge, ends_[host].weight_bits);
    history_.update_end(host);
  }
  void set_no_end(PointIndex host) {
    ends_[host] = kNever;
    vertices_.set_free(host);
    history_.update_end(host);
  }

  std::size_t expect_sound(PointIndex host) const { return expect_sound(host, joins_[host]); }

  std::size_t expect_sound(PointIndex host, const Joins& joins) const {
    std::vector<PointIndex> children;
    history_.for_each_guest(host, [&](PointIndex child) { children.push_back(child); });
    std::vector<PointIndex> expected;
    std::uint32_t total = 1;
    for (const Join& join : joins) {
      expected.push_back(join.child);
      total += join.size;
    }
    EXPECT_EQ(children, expected) << "of host " << host;
    EXPECT_EQ(history_.total(host), total) << "of host " << host;
    const float last_weight = joins.empty() ? 0.0F : joins.back().key.weight();
    EXPECT_EQ(history_.final_theta(host), kRule.theta(last_weight, total)) << "of host " << host;
    EXPECT_EQ(history_.first_broken(host), first_broken(host, joins)) << "of host " << host;
    return testing::HistoryCheck(vertices_, edges_, kRule).expect_sound(host);
  }

  void expect_state_before(PointIndex host, const EdgeKey& time) const {
    JoinHistory::State expected;
    for (const Join& join : joins_[host]) {
      if (!(join.key < time)) break;
      expected.size += join.size;
      expected.weight = join.key.weight();
    }
    const JoinHistory::State state = history_.state_before(host, time);
    EXPECT_EQ(state.size, expected.size) << "of host " << host;
    EXPECT_EQ(state.weight, expected.weight) << "of host " << host;
  }

 private:
  Joins::iterator first_after(PointIndex host, const EdgeKey& time) {
    return std::upper_bound(joins_[host].begin(), joins_[host].end(), time,
                            [](const EdgeKey& t, const Join& join) { return t < join.key; });
  }

  void set_free(PointIndex child) {
    edges_.release(vertices_[child].edge);
    vertices_.set_free(child);
    free_.push_back(child);
  }

  /// Goes through the joins with the predicate of Algorithm 1.
  PointIndex first_broken(PointIndex host, const Joins& joins) const {
    double theta = kRule.threshold;
    std::uint32_t size = 1;
    for (const Join& join : joins) {
      if (!(join.key.weight() < theta)) return join.child;
      size += join.size;
      theta = kRule.theta(join.key.weight(), size);
    }
    const bool is_broken =
        ends_[host] != kNever && !joins.empty() && !(ends_[host].weight() < theta);
    return is_broken ? host : kNone;
  }

  Vertices vertices_;
  TreeEdges edges_{vertices_};
  JoinHistory history_{vertices_, edges_, kRule};
  std::vector<PointIndex> free_;
  std::vector<Joins> joins_;
  std::vector<EdgeKey> ends_;
};

TEST(JoinHistory, OfAPointThatAbsorbedNothing) {
  Histories histories(1);
  const JoinHistory& history = histories.history();
  EXPECT_EQ(history.total(0), 1U);
  EXPECT_EQ(history.final_theta(0), kRule.threshold);
  EXPECT_EQ(history.first_broken(0), kNone);
  EXPECT_EQ(history.state_before(0, kNever).size, 1U);
  histories.expect_sound(0);
}

TEST(JoinHistory, FindsTheFirstJoinThatCannotBeMade) {
  // After 5 points at 0.0004, theta is 0.0005.
  Histories histories(3);
  histories.insert(0, 0.0004F, 4);
  histories.insert(0, 0.00045F, 5);
  histories.insert(0, 0.00048F, 1);
  const Joins joins = histories.joins(0);
  EXPECT_EQ(histories.history().first_broken(0), kNone);
  histories.update_size(0, 0, 9);  // theta 0.00045
  EXPECT_EQ(histories.history().first_broken(0), joins[1].child);
  histories.update_size(0, 0, 4);
  histories.update_size(0, 1, 20);
  EXPECT_EQ(histories.history().first_broken(0), joins[2].child);
  histories.update_size(0, 1, 5);
  histories.set_end(0, 0.0006F);
  EXPECT_EQ(histories.history().first_broken(0), 0U);
  histories.set_end(0, 0.0005F);
  EXPECT_EQ(histories.history().first_broken(0), kNone);
  histories.expect_sound(0);
}

TEST(JoinHistory, AFirstJoinMustBeBelowT) {
  Histories histories(1);
  histories.insert(0, 0.001F, 1);  // rounds to a float above T
  EXPECT_EQ(histories.history().first_broken(0), histories.joins(0)[0].child);
}

TEST(JoinHistory, FirstChildThatIsWantedInOrder) {
  Histories histories(3);
  for (const float weight : {0.0003F, 0.0001F, 0.0002F}) histories.insert(0, weight, 1);
  const Joins& joins = histories.joins(0);
  const JoinHistory& history = histories.history();
  EXPECT_EQ(history.first_guest_that(0, [](PointIndex) { return true; }), joins[0].child);
  const auto is_last = [&](PointIndex x) { return x == joins[2].child; };
  EXPECT_EQ(history.first_guest_that(0, is_last), joins[2].child);
  EXPECT_EQ(history.first_guest_that(0, [](PointIndex) { return false; }), kNone);
}

TEST(JoinHistory, EqualWeightsAreInTheOrderOfTheirEdges) {
  Histories histories(100);
  fuzz::Random random(1);
  while (histories.has_free()) {
    histories.insert(static_cast<PointIndex>(random.below(2)), 0.0002F, 1);
  }
  for (const PointIndex host : {0U, 1U}) {
    histories.expect_sound(host);
    for (const Join& join : Joins(histories.joins(host))) {
      histories.expect_state_before(host, join.key);
    }
  }
  histories.split_after(0, histories.joins(0)[10].key);
  histories.erase(1, 7);
  histories.expect_sound(0);
  histories.expect_sound(1);
}

class JoinHistoryAgainstLists : public ::testing::TestWithParam<int> {
 protected:
  static constexpr PointIndex kNumChildren = 60;

  float random_weight() {
    return static_cast<float>(num_weights_ == 0
                                  ? random_.log_uniform(1e-6, kHeaviest)
                                  : kHeaviest * static_cast<double>(random_.below(num_weights_)) /
                                        static_cast<double>(num_weights_));
  }
  std::uint32_t random_size() { return static_cast<std::uint32_t>(random_.log_uniform(1.0, 30.0)); }
  PointIndex random_host() { return static_cast<PointIndex>(random_.below(Histories::kNumHosts)); }
  /// The key of a join, of an edge of its weight, or none of these.
  EdgeKey random_time() {
    const Joins& joins = histories_.joins(random_host());
    if (joins.empty() || random_.chance(0.3)) return EdgeKey::of(random_weight(), 0, 30);
    const EdgeKey key = random_.pick(joins).key;
    return random_.chance(0.7) ? key : EdgeKey{key.weight_bits, 0, kNumChildren / 2};
  }

  void change() {
    const PointIndex host = random_host();
    const Joins& joins = histories_.joins(host);
    const double choice = random_.unit();
    if (choice < 0.5) {
      if (histories_.has_free()) histories_.insert(host, random_weight(), random_size());
    } else if (choice < 0.65) {
      if (!joins.empty()) histories_.erase(host, random_.below(joins.size()));
    } else if (choice < 0.8) {
      if (!joins.empty()) {
        histories_.update_size(host, random_.below(joins.size()), random_size());
      }
    } else if (choice < 0.85) {
      random_.chance(0.5) ? histories_.set_end(host, random_weight()) : histories_.set_no_end(host);
    } else if (choice < 0.9) {
      histories_.split_after(host, random_time());
    } else if (choice < 0.97) {
      histories_.hand_over(host, (host + 1) % Histories::kNumHosts, random_time());
    } else {
      Joins fresh;
      for (std::size_t n = random_.below(30); n > 0 && histories_.has_free(); --n) {
        fresh.push_back(histories_.new_join(host, random_weight(), random_size()));
      }
      histories_.build(host, std::move(fresh));
    }
  }

  std::size_t num_weights_ = static_cast<std::size_t>(GetParam());  ///< 0: as many as there are
  fuzz::Random random_{1};
  Histories histories_{kNumChildren};
};

TEST_P(JoinHistoryAgainstLists, Agrees) {
  std::size_t longest = 0;
  for (int step = 0; step < 10'000; ++step) {
    change();
    for (PointIndex host = 0; host < Histories::kNumHosts; ++host) {
      histories_.expect_sound(host);
      histories_.expect_state_before(host, random_time());
      longest = std::max(longest, histories_.joins(host).size());
    }
    ASSERT_FALSE(HasFailure()) << "step " << step;
  }
  EXPECT_GT(longest, 20U);
}

INSTANTIATE_TEST_SUITE_P(Weights, JoinHistoryAgainstLists, ::testing::Values(0, 1, 5));

/// A treap of n nodes is hardly ever deeper than 4.3 ln n, which is 43 here; refresh_path() holds
/// 128.
constexpr PointIndex kManyChildren = 20'000;
constexpr std::size_t kDeepest = 43;

TEST(JoinHistoryDepth, IsLogarithmicWhateverTheOrderOfInsertion) {
  for (const int order : {-1, 0, 1}) {
    Histories histories(kManyChildren);
    fuzz::Random random(1);
    for (PointIndex k = 0; k < kManyChildren; ++k) {
      const double weight = order == 0 ? random.unit() : 0.5 + 1e-5 * order * k;
      histories.insert(0, static_cast<float>(weight * 1e-3), 1);
    }
    EXPECT_EQ(histories.history().total(0), kManyChildren + 1);
    EXPECT_LE(histories.expect_sound(0), kDeepest);
  }
}

TEST(JoinHistoryDepth, StaysLogarithmicWhenMostJoinsAreTakenBack) {
  Histories histories(kManyChildren);
  fuzz::Random random(2);
  while (histories.has_free()) histories.insert(0, static_cast<float>(1e-3 * random.unit()), 1);
  while (histories.joins(0).size() > kManyChildren / 10) {
    histories.erase(0, random.below(histories.joins(0).size()));
  }
  EXPECT_LE(histories.expect_sound(0), kDeepest);
}

}  // namespace
}  // namespace kintsugi::segmenter::exact
