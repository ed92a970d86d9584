#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/exact/watch_heaps.hpp"
#include "tests/fuzz/random.hpp"
#include "tests/segmenter/core/exact/watch_check.hpp"

namespace kintsugi::segmenter::exact {
namespace {

using testing::KnownWatch;

class WatchHeapsTest : public ::testing::Test {
 protected:
  static constexpr PointIndex kNumHolders = 5;
  static constexpr PointIndex kNumPoints = 30;

  WatchHeapsTest() { vertices_.resize(kNumPoints); }

  void insert(PointIndex holder, float weight, PointIndex watcher, PointIndex other) {
    watches_.insert(holder, watcher, EdgeKey::of(weight, watcher, other));
  }

  std::vector<float> pop_all(PointIndex holder) {
    std::vector<float> weights;
    for (; !watches_.empty(holder); watches_.pop(holder)) {
      weights.push_back(watches_.top(holder).key().weight());
    }
    return weights;
  }

  Vertices vertices_;
  WatchHeaps watches_{vertices_};
};

TEST_F(WatchHeapsTest, TopIsTheLightest) {
  insert(0, 0.3F, 1, 11);
  insert(0, 0.1F, 2, 12);
  insert(0, 0.2F, 1, 13);
  EXPECT_EQ(watches_.top(0).watcher, 2U);
  EXPECT_EQ(watches_.top(0).other, 12U);
  EXPECT_EQ(watches_.top(0).key(), EdgeKey::of(0.1F, 12, 2));
  EXPECT_THAT(pop_all(0), ::testing::ElementsAre(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(watches_.size(), 0U);
}

TEST_F(WatchHeapsTest, ATieIsBrokenByThePoints) {
  insert(0, 0.1F, 9, 8);
  insert(0, 0.1F, 3, 7);
  insert(0, 0.1F, 6, 3);
  std::vector<PointIndex> others;
  for (; !watches_.empty(0); watches_.pop(0)) others.push_back(watches_.top(0).other);
  EXPECT_THAT(others, ::testing::ElementsAre(3, 7, 8));
}

TEST_F(WatchHeapsTest, AnEdgeIsWatchedOnceByAnEnd) {
  insert(0, 0.1F, 1, 11);
  insert(0, 0.1F, 1, 11);
  insert(4, 0.1F, 1, 11);  // in whatever heap
  EXPECT_EQ(watches_.size(), 1U);
  EXPECT_TRUE(watches_.empty(4));
  insert(4, 0.1F, 11, 1);  // the other end is another watcher
  EXPECT_EQ(watches_.size(), 2U);
}

TEST_F(WatchHeapsTest, MeldMovesAll) {
  insert(0, 0.3F, 1, 11);
  insert(0, 0.1F, 2, 11);
  insert(4, 0.2F, 3, 11);
  watches_.meld(4, 0);
  EXPECT_TRUE(watches_.empty(0));
  watches_.meld(4, 4);
  watches_.meld(4, 0);
  EXPECT_THAT(pop_all(4), ::testing::ElementsAre(0.1F, 0.2F, 0.3F));
  insert(0, 0.3F, 1, 11);
  watches_.meld(4, 0);  // to an empty one
  EXPECT_THAT(pop_all(4), ::testing::ElementsAre(0.3F));
}

TEST_F(WatchHeapsTest, ErasesWhatIsNotThereWithoutEffect) {
  insert(0, 0.3F, 1, 11);
  watches_.erase(11, 1);
  watches_.erase(1, 12);
  watches_.erase_all_of(2);
  EXPECT_EQ(watches_.size(), 1U);
  watches_.erase(1, 11);
  EXPECT_EQ(watches_.size(), 0U);
  EXPECT_TRUE(watches_.empty(0));
}

/// Multisets of watches, by holder.
class Known {
 public:
  bool is_watching(PointIndex watcher, PointIndex other) const {
    return std::ranges::any_of(heaps_, [&](const auto& heap) {
      return std::ranges::any_of(heap.second, [&](const KnownWatch& watch) {
        return watch.watcher == watcher && other_of(watch) == other;
      });
    });
  }
  template <typename Which>
  void erase_if(Which&& which) {
    for (auto& [holder, heap] : heaps_) std::erase_if(heap, which);
  }
  std::multiset<KnownWatch>& of(PointIndex holder) { return heaps_[holder]; }
  void meld(PointIndex to, PointIndex from) {
    if (to != from) of(to).merge(of(from));
  }
  std::multiset<KnownWatch> at_watcher(PointIndex watcher) const {
    std::multiset<KnownWatch> found;
    for (const auto& [holder, heap] : heaps_) {
      for (const KnownWatch& watch : heap) {
        if (watch.watcher == watcher) found.insert(watch);
      }
    }
    return found;
  }
  std::size_t size() const {
    std::size_t size = 0;
    for (const auto& [holder, heap] : heaps_) size += heap.size();
    return size;
  }
  static PointIndex other_of(const KnownWatch& watch) {
    return watch.key.a == watch.watcher ? watch.key.b : watch.key.a;
  }

 private:
  std::map<PointIndex, std::multiset<KnownWatch>> heaps_;
};

class WatchHeapsAgainstMultisets : public WatchHeapsTest {
 protected:
  PointIndex random_holder() { return static_cast<PointIndex>(random_.below(kNumHolders)); }
  PointIndex random_point() { return static_cast<PointIndex>(random_.below(kNumPoints)); }

  /// The weight of an edge, from its ends: one of a few.
  static float weight_of(PointIndex x, PointIndex y) {
    return 1e-4F * static_cast<float>((x * y + x + y) % 7);
  }

  void insert_any() {
    const PointIndex holder = random_holder();
    const PointIndex watcher = random_point();
    const PointIndex other = random_point();
    if (watcher == other) return;
    const EdgeKey key = EdgeKey::of(weight_of(watcher, other), watcher, other);
    watches_.insert(holder, watcher, key);
    if (!known_.is_watching(watcher, other)) known_.of(holder).insert({key, watcher});
  }

  /// By the key and watcher of its top.
  void pop_any() {
    const PointIndex holder = random_holder();
    if (known_.of(holder).empty()) return;
    const WatchHeaps::Watch& top = watches_.top(holder);
    ASSERT_EQ(top.key(), known_.of(holder).begin()->key);
    ASSERT_EQ(known_.of(holder).erase({top.key(), top.watcher}), 1U);
    watches_.pop(holder);
  }

  void erase_any() {
    const PointIndex holder = random_holder();
    if (known_.of(holder).empty()) return;
    const auto which = static_cast<std::ptrdiff_t>(random_.below(known_.of(holder).size()));
    const KnownWatch watch = *std::next(known_.of(holder).begin(), which);
    watches_.erase(watch.watcher, Known::other_of(watch));
    known_.of(holder).erase(watch);
  }

  void erase_all_of_any() {
    const PointIndex watcher = random_point();
    watches_.erase_all_of(watcher);
    known_.erase_if([&](const KnownWatch& watch) { return watch.watcher == watcher; });
  }

  void meld_any() {
    const PointIndex to = random_holder();
    const PointIndex from = random_holder();
    watches_.meld(to, from);
    known_.meld(to, from);
  }

  void expect_as_known() {
    const testing::WatchCheck check(vertices_, watches_);
    for (PointIndex x = 0; x < kNumPoints; ++x) {
      ASSERT_EQ(check.in_heap_of(x), known_.of(x)) << "heap of " << x;
      ASSERT_EQ(check.at_watcher(x), known_.at_watcher(x)) << "watches of " << x;
      ASSERT_EQ(watches_.empty(x), known_.of(x).empty());
    }
    ASSERT_EQ(watches_.size(), known_.size());
  }

  fuzz::Random random_{1};
  Known known_;
};

TEST_F(WatchHeapsAgainstMultisets, Agree) {
  WatchId largest = 0;
  std::size_t most = 0;
  for (int step = 0; step < 10'000; ++step) {
    const double choice = random_.unit();
    const double inserting = step / 300 % 2 == 0 ? 0.8 : 0.3;
    if (choice < inserting) {
      insert_any();
    } else if (choice < inserting + 0.06) {
      pop_any();
    } else if (choice < inserting + 0.12) {
      erase_any();
    } else if (choice < inserting + 0.15) {
      erase_all_of_any();
    } else if (choice < inserting + 0.17) {
      meld_any();
    }
    expect_as_known();
    ASSERT_FALSE(HasFailure()) << "step " << step;
    most = std::max(most, known_.size());
    for (PointIndex x = 0; x < kNumPoints; ++x) {
      if (vertices_[x].watches != kNone) largest = std::max(largest, vertices_[x].watches);
    }
  }
  EXPECT_GT(most, 100U);
  EXPECT_LT(largest, most);  // places of watches that are gone are used again
}

TEST_F(WatchHeapsTest, ManyWatchesComeInOrder) {
  constexpr PointIndex kMany = 20'000;
  vertices_.resize(kMany);
  fuzz::Random random(1);
  std::vector<float> expected;
  for (PointIndex watcher = 0; watcher < kMany; ++watcher) {
    const auto weight = static_cast<float>(random.unit());
    insert(0, weight, watcher, kMany);
    if (watcher % 3 == 0) {
      watches_.erase(watcher, kMany);
    } else {
      expected.push_back(weight);
    }
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(pop_all(0), expected);
}

}  // namespace
}  // namespace kintsugi::segmenter::exact
