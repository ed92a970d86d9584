#include <algorithm>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "segmenter/evaluation/times/lag.hpp"

namespace kintsugi::segmenter {
namespace {

using Counts = std::vector<std::int64_t>;
using Times = std::vector<double>;

TEST(SlicesBehind, CountsTheEarlierSlicesThatAreNotDone) {
  // Done after 25, 50, 75 and 100 ms.
  const Counts behind = slices_behind(Counts{0, 10'000, 20'000, 30'000}, Times{25, 25, 25, 25});
  EXPECT_EQ(behind, (Counts{0, 1, 2, 2}));
  const LagSummary lag = summarize_lag(behind);
  EXPECT_EQ(lag.max_slices, 2);
  EXPECT_DOUBLE_EQ(lag.mean_slices, 1.25);
}

TEST(SlicesBehind, AreNoneForASegmenterThatIsFastEnough) {
  // Done at the very moment the next one is ready.
  EXPECT_EQ(slices_behind(Counts{5'000, 15'000, 25'000}, Times{10, 10, 10}), (Counts{0, 0, 0}));
}

TEST(SlicesBehind, GrowByOneForEveryTwoSlicesAtHalfTheSpeed) {
  constexpr int kNumSlices = 100;
  Counts ready_us;
  for (std::int64_t i = 0; i < kNumSlices; ++i) {
    ready_us.push_back(1'700'000'000'000'000 + 1'000 * i);
  }
  const Counts behind = slices_behind(ready_us, Times(kNumSlices, 2.0));
  for (int i = 0; i < kNumSlices; ++i) EXPECT_EQ(behind[i], (i + 1) / 2);
}

TEST(SlicesBehind, TakeSlicesInOrderWhateverTheirTimes) {
  // The third is told at 50 ms and has to wait for the second, which comes at 100 ms.
  EXPECT_EQ(slices_behind(Counts{0, 100'000, 50'000}, Times{1, 1, 1}), (Counts{0, 0, 1}));
}

TEST(SlicesBehind, AreOnTheWholeThoseThatFinishedSlicesLeaveBehind) {
  std::mt19937 random(3);
  std::exponential_distribution<double> pause_us(1.0 / 1000.0);
  std::exponential_distribution<double> run_ms(1.0 / 0.9);
  Counts ready_us;
  Times times_ms;
  std::int64_t now = 0;
  for (int i = 0; i < 500; ++i) {
    now += static_cast<std::int64_t>(pause_us(random));
    ready_us.push_back(now);
    times_ms.push_back(run_ms(random));
  }
  Counts left_behind;
  double finished_us = 0.0;
  for (std::size_t i = 0; i < ready_us.size(); ++i) {
    finished_us = std::max(finished_us, static_cast<double>(ready_us[i] - ready_us[0]));
    finished_us += 1e3 * times_ms[i];
    left_behind.push_back(std::count_if(
        ready_us.begin() + static_cast<std::ptrdiff_t>(i) + 1, ready_us.end(),
        [&](std::int64_t t) { return static_cast<double>(t - ready_us[0]) < finished_us; }));
  }
  Counts found = slices_behind(ready_us, times_ms);
  std::sort(found.begin(), found.end());
  std::sort(left_behind.begin(), left_behind.end());
  EXPECT_EQ(found, left_behind);
  EXPECT_GT(found.back(), 5);  // there was something to count
}

TEST(SlicesBehind, OfNothingAreNothing) {
  EXPECT_TRUE(slices_behind({}, {}).empty());
  EXPECT_EQ(summarize_lag({}).mean_slices, 0.0);
  EXPECT_THROW(slices_behind(Counts{0}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter
