#include <gtest/gtest.h>

#include "mapper/core/tracking/restart_rule.hpp"

namespace kintsugi::mapper {
namespace {

using enum TrackingState;

constexpr std::int64_t kPeriod_us = 100'000;

/// How many further frames like this one it takes until a part is to begin; `limit`: more.
int frames_until_due(RestartRule& rule, std::int64_t& utime, TrackingState state, int limit) {
  for (int i = 0; i < limit; ++i) {
    utime += kPeriod_us;
    if (rule.is_due(utime, state)) return i;
  }
  return limit;
}

TEST(RestartRule, IsDueOnceTheCameraWasLostForSoLong) {
  RestartRule rule(2.0);
  std::int64_t utime = 1'700'000'000'000'000;
  EXPECT_EQ(frames_until_due(rule, utime, kTracking, 100), 100);
  EXPECT_EQ(frames_until_due(rule, utime, kLost, 100), 20) << "2 s after the first lost frame";
  EXPECT_EQ(frames_until_due(rule, utime, kLost, 100), 0) << "until a part begins";
  rule.count_anew();
  EXPECT_EQ(frames_until_due(rule, utime, kLost, 100), 20) << "and anew in the next part";
}

TEST(RestartRule, CountsAnewAfterAFrameThatIsNotLost) {
  RestartRule rule(2.0);
  std::int64_t utime = 0;
  for (const TrackingState state : {kTracking, kStarting, kGiven}) {
    EXPECT_EQ(frames_until_due(rule, utime, kLost, 19), 19);
    EXPECT_FALSE(rule.is_due(utime += kPeriod_us, state));
  }
  EXPECT_EQ(frames_until_due(rule, utime, kLost, 100), 20);
}

TEST(RestartRule, DoesNotCountTheTimeOfADisconnectedCamera) {
  RestartRule rule(2.0);
  std::int64_t utime = 0;
  EXPECT_FALSE(rule.is_due(utime, kLost));
  EXPECT_FALSE(rule.is_due(utime += 3'600'000'000, kLost));
  EXPECT_EQ(frames_until_due(rule, utime, kLost, 100), 9) << "the gap counts as 1 s";
}

TEST(RestartRule, IsNeverDueWhenItIsOff) {
  RestartRule rule(0.0);
  std::int64_t utime = 0;
  EXPECT_EQ(frames_until_due(rule, utime, kLost, 1000), 1000);
}

}  // namespace
}  // namespace kintsugi::mapper
