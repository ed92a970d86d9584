#include <algorithm>
#include <random>
#include <ranges>
#include <set>

#include <gtest/gtest.h>

#include "lcmtypes/sequence_set.hpp"

namespace kintsugi {
namespace {

TEST(SequenceSet, FindsTheGapsUpToAnEnd) {
  SequenceSet set;
  for (const std::int64_t number : {2, 3, 7}) EXPECT_TRUE(set.insert(number));
  EXPECT_EQ(set.missing(0, 10, 100), (std::vector<SequenceRange>{{0, 1}, {4, 6}, {8, 9}}));
  EXPECT_EQ(set.missing(0, 10, 2), (std::vector<SequenceRange>{{0, 1}, {4, 6}}));
  EXPECT_EQ(set.missing(0, 8, 100), (std::vector<SequenceRange>{{0, 1}, {4, 6}}));
  EXPECT_EQ(set.count_missing(0, 10), 7);
  EXPECT_EQ(set.num_ranges(), 2U);
}

TEST(SequenceSet, AgreesWithAPlainSetUnderRandomInsertsAndErasures) {
  constexpr std::int64_t kEnd = 60;
  std::mt19937 random(3);
  SequenceSet set;
  std::set<std::int64_t> plain;
  for (int step = 0; step < 20'000; ++step) {
    const std::int64_t number = random() % kEnd;
    if (random() % 3 == 0) {
      set.erase(number);
      plain.erase(number);
    } else {
      EXPECT_EQ(set.insert(number), plain.insert(number).second);
    }
    ASSERT_EQ(set.contains(number), plain.contains(number));
    std::set<std::int64_t> missing;
    for (const auto& [first, last] : set.missing(0, kEnd, 100)) {
      for (std::int64_t i = first; i <= last; ++i) missing.insert(i);
    }
    ASSERT_EQ(missing.size() + plain.size(), static_cast<std::size_t>(kEnd));
    for (const std::int64_t i : missing) ASSERT_FALSE(plain.contains(i));
    ASSERT_EQ(set.count_missing(0, kEnd), static_cast<std::int64_t>(missing.size()));
    const std::int64_t begin = random() % kEnd;
    std::set<std::int64_t> behind;
    for (const auto& [first, last] : set.ranges_from(begin, 100)) {
      for (std::int64_t i = first; i <= last; ++i) behind.insert(i);
    }
    ASSERT_TRUE(
        std::ranges::equal(behind, std::ranges::subrange(plain.lower_bound(begin), plain.end())));
    ASSERT_LE(set.ranges_from(begin, 1).size(), 1U);
  }
}

}  // namespace
}  // namespace kintsugi
