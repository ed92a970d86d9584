#include <random>
#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/stream/resend_queue.hpp"

namespace kintsugi {
namespace {

using ::testing::ElementsAre;

constexpr std::int64_t kEnd = 100;

/// Takes all resends while no new chunk waits.
std::vector<std::int64_t> drain(ResendQueue& queue) {
  std::vector<std::int64_t> sequences;
  while (const auto sequence = queue.next(false)) sequences.push_back(*sequence);
  return sequences;
}

void want(ResendQueue& queue, const std::vector<SequenceRange>& ranges, double now_s) {
  queue.want(ranges, 0, kEnd, now_s);
}

TEST(ResendQueue, ResendsInTheOrderOfRequestsAndEachNumberOnce) {
  ResendQueue queue;
  want(queue, {{10, 12}}, 1.0);
  want(queue, {{3, 4}, {11, 13}}, 1.0);
  EXPECT_EQ(queue.size(), 6);
  EXPECT_THAT(drain(queue), ElementsAre(10, 11, 12, 3, 4, 13));
  EXPECT_TRUE(queue.empty());
}

TEST(ResendQueue, IgnoresARequestShortlyAfterTheChunkWasSent) {
  ResendQueue queue;
  queue.sent(5, 1.0);
  want(queue, {{4, 6}}, 1.0 + 0.9 * ResendQueue::kInFlight_s);
  EXPECT_THAT(drain(queue), ElementsAre(4, 6));
  want(queue, {{5, 5}}, 1.0 + 1.1 * ResendQueue::kInFlight_s);
  EXPECT_THAT(drain(queue), ElementsAre(5));
}

TEST(ResendQueue, EveryEighthChunkIsAResendWhileNewChunksWait) {
  ResendQueue queue;
  want(queue, {{0, 9}}, 1.0);
  int resends = 0;
  for (int i = 0; i < 40; ++i) resends += queue.next(true) ? 1 : 0;
  EXPECT_EQ(resends, 5);
  EXPECT_EQ(drain(queue).size(), 5U);  // no new chunk waits: all at once
}

TEST(ResendQueue, IsBoundedByWhatCanBeSentForAnyRequest) {
  ResendQueue queue;
  const std::vector<SequenceRange> absurd(kMaxResendRanges, {0, kMaxSequence});
  for (int i = 0; i < 100; ++i) queue.want(absurd, 20, 70, 1.0);
  EXPECT_EQ(queue.size(), 50);
  EXPECT_EQ(drain(queue).front(), 20);
  queue.want(absurd, 70, 70, 2.0);  // nothing can be sent
  EXPECT_TRUE(queue.empty());
}

TEST(ResendQueue, AgreesWithAPlainSetUnderRandomRequests) {
  std::mt19937 random(5);
  ResendQueue queue;
  std::set<std::int64_t> wanted;
  std::vector<double> sent_s(kEnd, -1.0);
  double now_s = 0.0;
  for (int step = 0; step < 20'000; ++step) {
    now_s += 0.001 * static_cast<double>(random() % 10);
    if (random() % 4 == 0) {
      std::vector<SequenceRange> ranges;
      for (std::size_t i = random() % 4; i > 0; --i) {
        const std::int64_t first = random() % kEnd;
        ranges.push_back({first, first + static_cast<std::int64_t>(random() % 20)});
      }
      const std::int64_t begin = random() % 50;
      queue.want(ranges, begin, kEnd, now_s);
      for (const SequenceRange& range : ranges) {
        for (auto i = std::max(begin, range.first); i <= std::min(range.last, kEnd - 1); ++i) {
          const double sent = sent_s[static_cast<std::size_t>(i)];
          if (sent < 0.0 || now_s - sent >= ResendQueue::kInFlight_s) wanted.insert(i);
        }
      }
    } else if (const auto sequence = queue.next(random() % 2 == 0)) {
      ASSERT_EQ(wanted.erase(*sequence), 1U);
      queue.sent(*sequence, now_s);
      sent_s[static_cast<std::size_t>(*sequence)] = now_s;
    }
    ASSERT_EQ(queue.size(), static_cast<std::int64_t>(wanted.size()));
  }
}

}  // namespace
}  // namespace kintsugi
