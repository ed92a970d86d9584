#include <algorithm>
#include <cstddef>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/process/fusion_pace.hpp"

namespace kintsugi::mapper {
namespace {

/// Which of the frames are fused while always so many wait.
std::vector<bool> fused_while_waiting(std::size_t num_waiting, int num_frames) {
  FusionPace pace;
  std::vector<bool> fused;
  for (int i = 0; i < num_frames; ++i) fused.push_back(pace.fuses(num_waiting));
  return fused;
}

TEST(FusionPace, FusesEveryFrameWhileTheMapperKeepsUp) {
  EXPECT_THAT(fused_while_waiting(0, 100), ::testing::Each(true));
  EXPECT_THAT(fused_while_waiting(1, 100), ::testing::Each(true));
}

TEST(FusionPace, LeavesOutAsManyInARowAsWait) {
  EXPECT_THAT(fused_while_waiting(2, 7),
              ::testing::ElementsAre(false, false, true, false, false, true, false));
  const auto fused = fused_while_waiting(FusionPace::kMaxWaiting, 160);
  EXPECT_EQ(std::ranges::count(fused, true), 10) << "the map grows however slow the machine is";
}

TEST(FusionPace, CatchesUpWithFramesThatCost60PercentWhenNotFused) {
  // Fused, a frame takes 40 ms at 30 Hz: behind by 200 ms in a second.
  FusionPace pace;
  double behind_ms = 0.0;
  int num_fused = 0;
  for (int i = 0; i < 3'000; ++i) {
    const bool fuses = pace.fuses(static_cast<std::size_t>(behind_ms / (100.0 / 3.0)));
    num_fused += static_cast<int>(fuses);
    behind_ms = std::max(0.0, behind_ms + (fuses ? 40.0 : 24.0) - 100.0 / 3.0);
    EXPECT_LT(behind_ms, 120.0) << "frame " << i;
  }
  // 40 x + 24 (1 - x) = 33.3
  EXPECT_NEAR(num_fused, 3'000 * (100.0 / 3.0 - 24.0) / 16.0, 60);
}

}  // namespace
}  // namespace kintsugi::mapper
