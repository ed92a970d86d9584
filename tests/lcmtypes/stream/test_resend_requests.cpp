#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/stream/resend_requests.hpp"

namespace kintsugi {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pointwise;

constexpr double kTick_s = 0.01;

/// A receiver that is polled every kTick_s.
struct Schedule {
  ResendRequests requests{ResendRequests::Config{}};
  SequenceSet seen;
  std::int64_t end = 0;
  ResendRequests::Limits limits{1'000, 1'000'000, 1'000'000};
  bool heard = true;
  double now_s = 0.0;
  std::vector<double> asked_s;
  std::vector<SequenceRange> last;

  void arrive(std::int64_t sequence) {
    seen.insert(sequence);
    requests.arrived({sequence, sequence});
  }
  void run_until(double time_s) {
    for (; now_s < time_s; now_s += kTick_s) {
      auto ranges = requests.poll(seen, 0, end, limits, heard, now_s);
      if (ranges.empty()) continue;
      asked_s.push_back(now_s);
      last = std::move(ranges);
    }
  }
};

// A poll is up to one tick late, and the next wait starts there.
auto at_times(const std::vector<double>& times_s) {
  return Pointwise(DoubleNear(kTick_s * static_cast<double>(times_s.size() + 1)), times_s);
}

TEST(ResendRequests, WaitsForChunksThatAreOnlyOutOfOrder) {
  Schedule schedule;
  schedule.end = 3;
  schedule.arrive(0);
  schedule.arrive(2);
  schedule.run_until(0.04);
  schedule.arrive(1);
  schedule.run_until(1.0);
  EXPECT_THAT(schedule.asked_s, IsEmpty());
}

TEST(ResendRequests, AsksAfterAWaitAndLessAndLessOften) {
  Schedule schedule;
  schedule.end = 10;
  for (const int sequence : {0, 1, 4, 9}) schedule.arrive(sequence);
  schedule.run_until(4.5);
  EXPECT_THAT(schedule.asked_s, at_times({0.05, 0.15, 0.35, 0.75, 1.55, 2.55, 3.55}));
  EXPECT_THAT(schedule.last, ElementsAre(SequenceRange{2, 3}, SequenceRange{5, 8}));
  EXPECT_FALSE(schedule.requests.has_given_up());
}

TEST(ResendRequests, AsksSoonAgainAfterAnAnswer) {
  Schedule schedule;
  schedule.end = 10;
  schedule.run_until(1.6);
  schedule.arrive(3);
  schedule.asked_s.clear();
  schedule.run_until(2.2);
  EXPECT_THAT(schedule.asked_s, at_times({1.7, 1.8, 2.0}));
}

TEST(ResendRequests, AChunkThatWasNotRequestedIsNoAnswer) {
  Schedule schedule;
  schedule.end = 10;
  schedule.arrive(9);
  schedule.run_until(1.6);
  schedule.end = 12;
  schedule.arrive(11);
  schedule.asked_s.clear();
  schedule.run_until(2.2);
  EXPECT_THAT(schedule.asked_s, IsEmpty());
}

TEST(ResendRequests, GivesUpWithoutAnswersAndTriesAgainWhileTheSenderIsHeard) {
  Schedule schedule;
  schedule.end = 10;
  schedule.run_until(5.2);
  EXPECT_TRUE(schedule.requests.has_given_up());
  schedule.asked_s.clear();
  schedule.run_until(30.0);
  EXPECT_THAT(schedule.asked_s, at_times({15.05, 25.05}));
  EXPECT_TRUE(schedule.requests.has_given_up());
  schedule.heard = false;
  schedule.asked_s.clear();
  schedule.run_until(200.0);
  EXPECT_LE(schedule.asked_s.size(), 1U);
}

TEST(ResendRequests, AnAnswerAfterGivingUpRestartsTheRequests) {
  Schedule schedule;
  schedule.end = 10;
  schedule.run_until(16.0);
  schedule.arrive(0);
  schedule.asked_s.clear();
  schedule.run_until(16.2);
  EXPECT_FALSE(schedule.requests.has_given_up());
  EXPECT_EQ(schedule.asked_s.size(), 1U);
}

TEST(ResendRequests, AReturnedSenderIsAskedAtOnce) {
  Schedule schedule;
  schedule.end = 10;
  schedule.heard = false;
  schedule.run_until(7.0);
  EXPECT_TRUE(schedule.requests.has_given_up());
  schedule.heard = true;
  schedule.asked_s.clear();
  schedule.run_until(7.05);
  EXPECT_THAT(schedule.asked_s, at_times({7.0}));
  EXPECT_FALSE(schedule.requests.has_given_up());
}

TEST(ResendRequests, TimeWithoutMemoryDoesNotCountTowardsGivingUp) {
  Schedule schedule;
  schedule.end = 10;
  schedule.run_until(1.0);
  for (double now_s = 1.0; now_s < 60.0; now_s += kTick_s) schedule.requests.pause(now_s);
  schedule.now_s = 60.0;
  schedule.asked_s.clear();
  schedule.run_until(60.5);
  EXPECT_FALSE(schedule.requests.has_given_up());
  EXPECT_FALSE(schedule.asked_s.empty());
}

TEST(ResendRequests, AsksForALimitedNumberAndThenForMore) {
  Schedule schedule;
  schedule.end = 100;
  schedule.arrive(2);
  schedule.limits.max_numbers = 5;
  schedule.run_until(0.07);
  EXPECT_THAT(schedule.last, ElementsAre(SequenceRange{0, 1}, SequenceRange{3, 5}));
  for (const int sequence : {0, 1, 3, 4, 5}) schedule.arrive(sequence);
  schedule.asked_s.clear();
  schedule.run_until(0.09);
  EXPECT_EQ(schedule.asked_s.size(), 1U);
  EXPECT_THAT(schedule.last, ElementsAre(SequenceRange{6, 10}));
}

TEST(ResendRequests, AsksForNothingBeyondItsLimits) {
  Schedule schedule;
  schedule.end = 100;
  for (std::int64_t i = 0; i < 100; i += 2) schedule.arrive(i);
  schedule.limits.max_ranges = 3;
  schedule.run_until(0.07);
  EXPECT_THAT(schedule.last,
              ElementsAre(SequenceRange{1, 1}, SequenceRange{3, 3}, SequenceRange{5, 5}));
  schedule.limits = {1'000, 1'000, 10};
  schedule.run_until(0.2);
  EXPECT_EQ(schedule.last.back(), (SequenceRange{9, 9}));
}

TEST(ResendRequests, StartsAnewWithEachGapAfterEverythingIsReceived) {
  Schedule schedule;
  schedule.end = 1;
  schedule.run_until(3.0);
  schedule.arrive(0);
  schedule.run_until(4.0);
  schedule.end = 2;
  schedule.asked_s.clear();
  schedule.run_until(4.5);
  EXPECT_THAT(schedule.asked_s, at_times({4.05, 4.15, 4.35}));
}

}  // namespace
}  // namespace kintsugi
