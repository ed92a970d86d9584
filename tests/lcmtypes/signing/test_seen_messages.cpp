#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "lcmtypes/signing/seen_messages.hpp"

namespace kintsugi {
namespace {

/// A session that began at this second.
std::uint64_t session_of(std::uint64_t second, std::uint64_t number = 0) {
  return second << 32U | number;
}

TEST(SeenMessages, TakesEachNumberOfASessionOnce) {
  SeenMessages seen;
  EXPECT_TRUE(seen.take(session_of(5), 1));
  EXPECT_FALSE(seen.take(session_of(5), 1));
  EXPECT_TRUE(seen.take(session_of(5), 2));
  EXPECT_TRUE(seen.take(session_of(5, 1), 2));
  EXPECT_FALSE(seen.take(session_of(5, 1), 2));
  EXPECT_FALSE(seen.take(session_of(5), 2));
}

TEST(SeenMessages, TakesNoNumberThatNoSenderUses) {
  SeenMessages seen;
  for (const std::int64_t number :
       {std::int64_t{0}, std::int64_t{-1}, std::numeric_limits<std::int64_t>::min(),
        std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_FALSE(seen.take(session_of(5), number));
  }
}

TEST(SeenMessages, LosesNothingToDisorderAndTakesNothingTwice) {
  constexpr int kCount = 20'000;
  constexpr int kLatest = 3'000;  // so many places away from its own
  std::mt19937 random(3);
  std::vector<std::int64_t> numbers(kCount);
  std::iota(numbers.begin(), numbers.end(), 1);
  for (std::size_t i = 0; i + kLatest < numbers.size(); ++i) {
    if (random() % 4 == 0) std::swap(numbers[i], numbers[i + random() % kLatest]);
  }
  SeenMessages seen;
  std::set<std::int64_t> taken;
  for (const std::int64_t number : numbers) {
    if (random() % 10 == 0) continue;  // lost
    EXPECT_EQ(seen.take(session_of(5), number), taken.insert(number).second);
    const std::int64_t repeated = 1 + static_cast<std::int64_t>(random() % kCount);
    EXPECT_FALSE(taken.contains(repeated) && seen.take(session_of(5), repeated));
  }
  EXPECT_GT(taken.size(), kCount * 8U / 10U);
}

TEST(SeenMessages, ClosesTheLowestGapOfASenderWithTooMany) {
  SeenMessages seen({.gaps_per_session = 3, .gaps = 100});
  for (const std::int64_t number : {2, 4, 6}) EXPECT_TRUE(seen.take(session_of(5), number));
  EXPECT_TRUE(seen.take(session_of(5), 8));
  EXPECT_FALSE(seen.take(session_of(5), 1));  // so late that nobody knows
  EXPECT_TRUE(seen.take(session_of(5), 7));
  EXPECT_TRUE(seen.take(session_of(5), 3));
  EXPECT_TRUE(seen.take(session_of(5), 5));
  for (const std::int64_t number : {1, 2, 3, 4, 5, 6, 7, 8}) {
    EXPECT_FALSE(seen.take(session_of(5), number));
  }
}

TEST(SeenMessages, RefusesWhatAForgottenSenderHasSent) {
  SeenMessages seen({.gaps_per_session = 10, .gaps = 3});
  for (const std::uint64_t second : {7, 5, 6}) EXPECT_TRUE(seen.take(session_of(second), 1));
  EXPECT_TRUE(seen.take(session_of(7), 2));  // so 5 is silent for the longest time
  EXPECT_TRUE(seen.take(session_of(8), 1));
  EXPECT_EQ(seen.num_sessions(), 3U);
  EXPECT_FALSE(seen.take(session_of(5), 1));
  EXPECT_FALSE(seen.take(session_of(5), 2));
  EXPECT_FALSE(seen.take(session_of(4), 1));  // may have been forgotten earlier
  for (const std::uint64_t second : {6, 7, 8}) EXPECT_FALSE(seen.take(session_of(second), 1));
  EXPECT_TRUE(seen.take(session_of(6), 2));
  EXPECT_TRUE(seen.take(session_of(7), 3));
  EXPECT_TRUE(seen.take(session_of(8), 2));
  EXPECT_EQ(seen.num_sessions(), 3U);
}

TEST(SeenMessages, ARepetitionDoesNotKeepASenderFromBeingForgotten) {
  SeenMessages seen({.gaps_per_session = 10, .gaps = 2});
  EXPECT_TRUE(seen.take(session_of(5), 1));
  EXPECT_TRUE(seen.take(session_of(6), 1));
  EXPECT_FALSE(seen.take(session_of(5), 1));
  EXPECT_TRUE(seen.take(session_of(7), 1));
  EXPECT_TRUE(seen.take(session_of(6), 2));
  EXPECT_FALSE(seen.take(session_of(5), 2));
}

TEST(SeenMessages, TheLastSenderIsKeptHoweverManyGapsItHas) {
  SeenMessages seen({.gaps_per_session = 10, .gaps = 2});
  for (const std::int64_t number : {1, 3, 5, 7}) EXPECT_TRUE(seen.take(session_of(5), number));
  EXPECT_EQ(seen.num_sessions(), 1U);
}

}  // namespace
}  // namespace kintsugi
