#include <algorithm>
#include <iterator>
#include <set>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/exact/event_queue.hpp"
#include "tests/fuzz/random.hpp"

namespace kintsugi::segmenter::exact {
namespace {

/// A key with one of `num_weights` weights between one of a few points and another.
EdgeKey random_key(fuzz::Random& random, std::size_t num_weights) {
  const auto weight = static_cast<float>(random.below(num_weights)) * 1e-6F;
  return EdgeKey::of(weight, static_cast<PointIndex>(random.below(50)),
                     static_cast<PointIndex>(50 + random.below(50)));
}

std::vector<EdgeKey> random_keys(fuzz::Random& random, std::size_t num_keys,
                                 std::size_t num_weights) {
  std::vector<EdgeKey> keys;
  while (keys.size() < num_keys) keys.push_back(random_key(random, num_weights));
  return keys;
}

TEST(EdgeKey, IsOfAnUndirectedEdge) {
  EXPECT_EQ(EdgeKey::of(0.5F, 3, 8), EdgeKey::of(0.5F, 8, 3));
  EXPECT_EQ(EdgeKey::of(0.5F, 8, 3).a, 3U);
  EXPECT_EQ(EdgeKey::of(0.5F, 8, 3).weight(), 0.5F);
}

TEST(EdgeKey, OrdersByWeightThenBySmallerPointThenByLarger) {
  const std::vector<EdgeKey> ascending = {
      {0, 0, 0},
      EdgeKey::of(0.0F, 0, 1),
      EdgeKey::of(1e-45F, 5, 9),  // the least float above 0
      EdgeKey::of(0.25F, 7, 1),
      EdgeKey::of(0.25F, 2, 3),
      EdgeKey::of(0.25F, 4, 2),
      EdgeKey::of(0.5F, 0, 1),
      EdgeKey::of(1e30F, 0, 1),
      kNever,
  };
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    for (std::size_t j = 0; j < ascending.size(); ++j) {
      EXPECT_EQ(ascending[i] < ascending[j], i < j) << i << " and " << j;
    }
  }
}

TEST(SortKeys, AsStdSort) {
  fuzz::Random random(1);
  for (const std::size_t num_keys : {0, 1, 2, 255, 256, 257, 1000, 20'000}) {
    for (const std::size_t num_weights : {1, 3, 1000, 1'000'000'000}) {
      std::vector<EdgeKey> keys = random_keys(random, num_keys, num_weights);
      std::vector<EdgeKey> expected = keys;
      std::sort(expected.begin(), expected.end());
      sort_keys(keys);
      ASSERT_EQ(keys, expected) << num_keys << " keys of " << num_weights << " weights";
    }
  }
}

TEST(SortKeys, AsStdSortWhateverTheBits) {
  fuzz::Random random(2);
  for (int round = 0; round < 40; ++round) {
    // Keys that differ in a few bits of the weight only, wherever these are.
    const auto mask =
        static_cast<std::uint32_t>(random.below(1ULL << 32U) & random.below(1ULL << 32U));
    std::vector<EdgeKey> keys;
    while (keys.size() < 2000) {
      keys.push_back({static_cast<std::uint32_t>(random.below(1ULL << 32U)) & mask,
                      static_cast<PointIndex>(random.below(4)), 4});
    }
    keys.push_back(kNever);
    std::vector<EdgeKey> expected = keys;
    std::sort(expected.begin(), expected.end());
    sort_keys(keys);
    ASSERT_EQ(keys, expected);
  }
}

std::vector<Event> pop_all(EventQueue& queue) {
  std::vector<Event> popped;
  while (!queue.empty()) popped.push_back(queue.pop());
  return popped;
}

TEST(EventQueue, TakesKindsInTheirOrderAtOneKey) {
  const EdgeKey key = EdgeKey::of(0.5F, 1, 2);
  EventQueue queue;
  queue.start({key, EdgeKey::of(0.25F, 3, 4)});
  queue.push({key, EventKind::kHeap, 7});
  queue.push({.key = key});
  queue.push({key, EventKind::kTreeEdge, 5});
  std::vector<EventKind> kinds;
  for (const Event& event : pop_all(queue)) kinds.push_back(event.kind);
  EXPECT_THAT(kinds, ::testing::ElementsAre(EventKind::kPlainEdge, EventKind::kTreeEdge,
                                            EventKind::kPlainEdge, EventKind::kPlainEdge,
                                            EventKind::kHeap));
}

TEST(EventQueue, KeepsArguments) {
  EventQueue queue;
  queue.start({});
  queue.push({EdgeKey::of(0.5F, 1, 2), EventKind::kHeap, 7});
  queue.push({EdgeKey::of(0.25F, 1, 2), EventKind::kTreeEdge, 5});
  EXPECT_EQ(queue.pop().argument, 5U);
  EXPECT_EQ(queue.pop().argument, 7U);
}

TEST(EventQueue, TellsWhichPlainEdgesAreToCome) {
  fuzz::Random random(3);
  std::vector<EdgeKey> keys = random_keys(random, 20, 100);
  EventQueue queue;
  queue.start(keys);
  std::sort(keys.begin(), keys.end());
  for (std::size_t next = 0; next < keys.size(); ++next) {
    for (std::size_t ahead = 0; ahead < 25; ++ahead) {
      const EdgeKey* const upcoming = queue.upcoming(ahead);
      ASSERT_EQ(upcoming != nullptr, next + ahead < keys.size());
      if (upcoming != nullptr) {
        ASSERT_EQ(*upcoming, keys[next + ahead]);
      }
    }
    queue.pop();
  }
  EXPECT_EQ(queue.upcoming(0), nullptr);
}

TEST(EventQueue, AgainstASortedMultisetWithPushesAmongPops) {
  fuzz::Random random(4);
  EventQueue queue;
  for (int run = 0; run < 50; ++run) {  // one queue: a run leaves nothing to the next
    const std::size_t num_weights = random.between(1, 200);
    const std::vector<EdgeKey> keys = random_keys(random, random.below(600), num_weights);
    std::multiset<Event> expected;
    for (const EdgeKey& key : keys) expected.insert({.key = key});
    queue.start(keys);
    for (int step = 0; step < 1500; ++step) {
      ASSERT_EQ(queue.empty(), expected.empty());
      if (random.chance(0.4)) {
        const Event event{random_key(random, num_weights), static_cast<EventKind>(random.below(3)),
                          0};
        queue.push(event);
        expected.insert(event);
      } else if (!expected.empty()) {
        const Event event = queue.pop();
        ASSERT_EQ(event.key, expected.begin()->key);
        ASSERT_EQ(event.kind, expected.begin()->kind);
        expected.erase(expected.begin());
      }
    }
  }
}

}  // namespace
}  // namespace kintsugi::segmenter::exact
