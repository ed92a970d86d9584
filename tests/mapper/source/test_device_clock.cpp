#include <gtest/gtest.h>

#include "mapper/source/frames/color_clock.hpp"
#include "mapper/source/frames/device_clock.hpp"

namespace kintsugi::mapper {
namespace {

using Stream = DeviceClock::Stream;

constexpr std::int64_t kPeriod_us = 33'333;
constexpr std::int64_t kSecond_us = 1'000'000;

DeviceClock::Instant at(std::int64_t arrival_us) {
  return DeviceClock::Instant(std::chrono::microseconds(arrival_us));
}

class Live : public testing::Test {
 protected:
  std::int64_t depth(std::int64_t stamp_us, std::int64_t arrival_us) {
    return clock_.time_of(Stream::kDepth, stamp_us, at(arrival_us));
  }
  std::int64_t color(std::int64_t stamp_us, std::int64_t arrival_us) {
    return clock_.time_of(Stream::kColor, stamp_us, at(arrival_us));
  }
  DeviceClock clock_{true, kPeriod_us};
};

TEST_F(Live, PassesOnAClockThatIsRight) {
  EXPECT_EQ(depth(5 * kSecond_us, 0), 5 * kSecond_us);
  EXPECT_EQ(color(5 * kSecond_us + 7, 10), 5 * kSecond_us + 7);
  EXPECT_EQ(depth(5 * kSecond_us + kPeriod_us, kPeriod_us + 900), 5 * kSecond_us + kPeriod_us);
  EXPECT_EQ(depth(9 * kSecond_us, 4 * kSecond_us), 9 * kSecond_us) << "a real gap";
}

TEST_F(Live, GoesOnByThePassedTimeWhenTheClockRestarts) {
  depth(5 * kSecond_us, 0);
  color(5 * kSecond_us, 0);
  EXPECT_EQ(depth(0, 40'000), 5 * kSecond_us + 40'000);
  EXPECT_EQ(color(100, 41'000), 5 * kSecond_us + 40'100) << "joins the depth images' epoch";
  EXPECT_EQ(depth(kPeriod_us, 75'000), 5 * kSecond_us + 40'000 + kPeriod_us);
}

TEST_F(Live, LetsTheOtherStreamFinishItsOldEpoch) {
  depth(5 * kSecond_us, 0);
  color(5 * kSecond_us, 0);
  depth(0, 40'000);
  EXPECT_EQ(color(5 * kSecond_us + kPeriod_us, 41'000), 5 * kSecond_us + kPeriod_us)
      << "it had been on its way";
  EXPECT_EQ(color(kPeriod_us, 75'000), 5 * kSecond_us + 40'000 + kPeriod_us);
}

TEST_F(Live, DoesNotFollowAJumpAhead) {
  depth(5 * kSecond_us, 0);
  EXPECT_EQ(depth(3600 * kSecond_us, kPeriod_us), 5 * kSecond_us + kPeriod_us);
  EXPECT_EQ(depth(3600 * kSecond_us + kPeriod_us, 2 * kPeriod_us), 5 * kSecond_us + 2 * kPeriod_us);
}

TEST_F(Live, AscendsStrictlyWhateverComes) {
  std::int64_t last = depth(100'000, 0);
  std::int64_t arrival = 0;
  for (const std::int64_t stamp :
       {100'000, 99'999, 90'000, 133'000, 0, 0, 1, 70'000'000, 2, 33'000}) {
    const std::int64_t time = depth(stamp, arrival += 30'000);
    EXPECT_GT(time, last) << stamp;
    EXPECT_LT(time, last + 2 * kSecond_us) << stamp;
    last = time;
  }
}

TEST(Replayed, DoesNotDependOnWhenImagesAreRead) {
  DeviceClock clock(false, kPeriod_us);
  const auto depth = [&](std::int64_t stamp_us, std::int64_t arrival_us) {
    return clock.time_of(Stream::kDepth, stamp_us, at(arrival_us));
  };
  EXPECT_EQ(depth(kSecond_us, 0), kSecond_us);
  EXPECT_EQ(depth(60 * kSecond_us, 10), 60 * kSecond_us) << "a gap of the recording";
  EXPECT_EQ(depth(0, 90 * kSecond_us), 60 * kSecond_us + kPeriod_us);
  clock.interrupt();
  EXPECT_EQ(depth(-kSecond_us, 92 * kSecond_us), 62 * kSecond_us + kPeriod_us)
      << "but what passed while the device was away has passed";
}

TEST(ColorClock, FindsASteadyDifference) {
  ColorClock clock(kPeriod_us);
  std::int64_t corrected = 0;
  for (std::int64_t i = 0; i < 12; ++i) {
    corrected = clock.add_color(i * kPeriod_us + 5'000'000);
    clock.add_depth(i * kPeriod_us);
  }
  EXPECT_EQ(clock.ahead_us(), 5'000'000);
  EXPECT_EQ(corrected, 11 * kPeriod_us);
}

TEST(ColorClock, LeavesLatenessAlone) {
  ColorClock clock(kPeriod_us);
  for (std::int64_t i = 0; i < 30; ++i) {
    clock.add_color((i - 2) * kPeriod_us);
    clock.add_depth(i * kPeriod_us);
  }
  EXPECT_EQ(clock.ahead_us(), 0);
}

TEST(ColorClock, IsNotMisledByColourThatComesNowAndThen) {
  ColorClock clock(kPeriod_us);
  for (std::int64_t i = 0; i < 200; ++i) {
    if (i % 20 == 0) clock.add_color(i * kPeriod_us);
    clock.add_depth(i * kPeriod_us);
  }
  EXPECT_EQ(clock.ahead_us(), 0);
}

}  // namespace
}  // namespace kintsugi::mapper
