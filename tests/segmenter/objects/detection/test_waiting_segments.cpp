#include <cstdint>
#include <limits>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/objects/detection/waiting_segments.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// In the order in which they are taken out.
std::vector<std::uint32_t> all_of(WaitingSegments& waiting) {
  std::vector<std::uint32_t> all;
  while (!waiting.empty()) all.push_back(waiting.pop().segment);
  return all;
}

TEST(WaitingSegments, ComeFirstWhenTheyHaveChangedMuch) {
  WaitingSegments waiting;
  waiting.add(7, 100, 1);
  waiting.add(8, 100, 2);
  waiting.add(7, 110, 3);  // waits already
  EXPECT_EQ(waiting.size(), 2U);
  const WaitingSegments::Next first = waiting.pop();
  EXPECT_EQ(first.segment, 7U);
  EXPECT_EQ(first.since_us, 1);
  EXPECT_EQ(waiting.pop().segment, 8U);

  waiting.add(7, 120, 4);  // a tenth more than when it was examined
  waiting.add(8, 140, 5);
  EXPECT_EQ(waiting.pop().segment, 8U);
  waiting.add(8, 150, 6);
  waiting.add(8, 70, 7);  // now it has lost half
  const WaitingSegments::Next smaller = waiting.pop();
  EXPECT_EQ(smaller.segment, 8U);
  EXPECT_EQ(smaller.since_us, 6);
  waiting.add(8, 71, 8);
  waiting.add(8, 71, 9, true);
  EXPECT_THAT(all_of(waiting), ElementsAre(8U, 7U));

  waiting.add(7, 121, 10);
  waiting.erase(7);
  EXPECT_FALSE(waiting.contains(7));
  EXPECT_TRUE(waiting.has_changed_much(7, 121));
  waiting.add(9, 50, 11, true);
  waiting.add(8, 0, 12);
  EXPECT_EQ(waiting.pop().segment, 8U);
  EXPECT_TRUE(waiting.contains(9));
  waiting.clear();
  EXPECT_FALSE(waiting.contains(9));
}

TEST(WaitingSegments, ThatAreMostLikeAnObjectComeBeforeTheOthersThatHaveChangedMuch) {
  WaitingSegments waiting;
  for (const std::uint32_t id : {1U, 2U, 3U, 4U}) waiting.add(id, 100, id);
  EXPECT_THAT(waiting.unranked(), ElementsAre(1, 2, 3, 4));
  waiting.rank(1, std::numeric_limits<float>::infinity());
  waiting.rank(2, 0.75F);
  waiting.rank(3, 0.25F);
  EXPECT_THAT(waiting.unranked(), ElementsAre(4));
  EXPECT_EQ(waiting.pop().segment, 4U) << "it may be like one";
  EXPECT_EQ(waiting.pop().segment, 3U);
  waiting.add(4, 110, 5);  // little has changed since it was examined
  waiting.add(2, 110, 6);  // nor since it was ranked
  EXPECT_THAT(waiting.unranked(), IsEmpty());
  waiting.add(2, 130, 7);
  EXPECT_THAT(waiting.unranked(), ElementsAre(2));
  waiting.rank(2, 0.5F);
  waiting.hurry(1);
  waiting.hurry(3);  // does not wait
  EXPECT_THAT(all_of(waiting), ElementsAre(1, 2, 4));
}

TEST(WaitingSegments, AreNotRankedAfterTheyWereTakenOut) {
  WaitingSegments waiting;
  for (const std::uint32_t id : {1U, 2U, 3U}) waiting.add(id, 100, id);
  waiting.pop();
  waiting.erase(2);
  EXPECT_THAT(waiting.unranked(), ElementsAre(3));
  waiting.add(3, 0, 4);
  EXPECT_THAT(waiting.unranked(), IsEmpty());
  waiting.clear();
  waiting.add(1, 100, 5);
  EXPECT_THAT(waiting.unranked(), ElementsAre(1)) << "what was examined is forgotten";
}

TEST(WaitingSegments, HaveEverySecondTurnWhenTheyHaveWaitedLong) {
  WaitingSegments waiting;
  for (const std::uint32_t id : {7U, 8U}) {
    waiting.add(id, 100, 1);
    waiting.pop();
  }
  constexpr std::int64_t kPatience_us = WaitingSegments::kPatience_us;
  waiting.add(7, 120, 10);
  waiting.add(8, 120, 20);
  // A segment that is new comes all the time.
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < 6; ++i) {
    waiting.add(100 + i, 50, 10 + kPatience_us * (i + 1) / 4);
    order.push_back(waiting.pop().segment);
  }
  EXPECT_THAT(order, ElementsAre(100, 101, 102, 7, 103, 8));
  EXPECT_THAT(all_of(waiting), ElementsAre(104, 105));
}

TEST(WaitingSegments, UnlikeAllObjectsHaveEverySecondTurnAfterAMinute) {
  WaitingSegments waiting;
  const auto add = [&waiting](std::uint32_t id, float distance, std::int64_t utime) {
    waiting.add(id, 100, utime);
    waiting.rank(id, distance);
  };
  add(1, 2.0F, 1);
  add(2, 3.0F, 2);
  // One that is like an object comes all the time.
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < 6; ++i) {
    add(100 + i, 0.5F, 2 + WaitingSegments::kLongPatience_us * i / 2);
    order.push_back(waiting.pop().segment);
  }
  EXPECT_THAT(order, ElementsAre(100, 101, 1, 102, 2, 103));
  EXPECT_THAT(all_of(waiting), ElementsAre(104, 105));
}

}  // namespace
}  // namespace kintsugi::segmenter
