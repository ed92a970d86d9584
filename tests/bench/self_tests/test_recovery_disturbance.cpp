#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/bench/recovery_disturbance.hpp"

namespace kintsugi::mapper::bench {
namespace {

constexpr std::int64_t kPeriod_us = 33'333;
constexpr int kFrames = 600;

int count(const Plan& plan, Damage damage) {
  return static_cast<int>(std::count_if(
      plan.begin(), plan.end(), [&](const PlannedFrame& frame) { return frame.damage == damage; }));
}

int wiped_pixels(const cv::Mat_<float>& depth_m) {
  return static_cast<int>(
      std::count_if(depth_m.begin(), depth_m.end(), [](float z) { return std::isnan(z); }));
}

TEST(RecoveryDisturbance, EveryPlanPlaysFramesThereAreInOrderOfTimeAndIsReproducible) {
  for (const std::string& name : disturbance_names()) {
    const Plan plan = plan_disturbance(name, kFrames, kPeriod_us, 7);
    ASSERT_FALSE(plan.empty()) << name;
    EXPECT_EQ(plan.front(), (PlannedFrame{0, 0, Damage::kNone})) << name;
    for (std::size_t i = 0; i < plan.size(); ++i) {
      EXPECT_GE(plan[i].frame, 0) << name;
      EXPECT_LT(plan[i].frame, kFrames) << name;
      const bool first = i == 0;
      EXPECT_TRUE(first || plan[i].utime > plan[i - 1].utime) << name;
    }
    EXPECT_EQ(plan, plan_disturbance(name, kFrames, kPeriod_us, 7)) << name;
  }
}

TEST(RecoveryDisturbance, SkipsFramesAtTheirOwnTimes) {
  const Plan plan = plan_disturbance("every-5", kFrames, kPeriod_us);
  EXPECT_EQ(plan.size(), 120U);
  EXPECT_EQ(plan[3], (PlannedFrame{15, 15 * kPeriod_us, Damage::kNone}));
}

TEST(RecoveryDisturbance, AGapLastsAsLongAsItSays) {
  const Plan plan = plan_disturbance("gap-5s", kFrames, kPeriod_us);
  std::int64_t longest_us = 0;
  for (std::size_t i = 1; i < plan.size(); ++i) {
    longest_us = std::max(longest_us, plan[i].utime - plan[i - 1].utime);
  }
  EXPECT_GE(longest_us, 5'000'000);
  EXPECT_LE(longest_us, 5'000'000 + 2 * kPeriod_us);
}

TEST(RecoveryDisturbance, SpoilsAFifthAndNeverTheStart) {
  for (const auto& [name, damage] :
       {std::pair{"wiped", Damage::kWiped}, {"cut-off", Damage::kCutOff}}) {
    const Plan plan = plan_disturbance(name, kFrames, kPeriod_us);
    // 590 draws of 0.2: 118 with a standard deviation of 10.
    EXPECT_NEAR(count(plan, damage), 118, 40);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(plan[i].damage, Damage::kNone);
  }
}

TEST(RecoveryDisturbance, CoversTheCameraForThreeSeconds) {
  EXPECT_EQ(count(plan_disturbance("covered", kFrames, kPeriod_us), Damage::kWiped), 90);
  EXPECT_EQ(count(plan_disturbance("covered-back", kFrames, kPeriod_us), Damage::kWiped), 90);
}

TEST(RecoveryDisturbance, AJumpLeadsBackToPlacesButToNoFrameSeenBefore) {
  const Plan plan = plan_disturbance("jump", kFrames, kPeriod_us);
  std::size_t jump = 0;
  while (jump + 1 < plan.size() && plan[jump + 1].frame > plan[jump].frame) ++jump;
  EXPECT_EQ(plan[jump].frame, 448);
  EXPECT_EQ(plan[jump + 1].frame, 61);
  EXPECT_EQ(plan[jump + 1].utime - plan[jump].utime, kPeriod_us);
  for (std::size_t i = 0; i < plan.size(); ++i) EXPECT_EQ(plan[i].frame % 2, i <= jump ? 0 : 1);
}

TEST(RecoveryDisturbance, WipesWhatItSaysAndLeavesTheRecordingAlone) {
  RgbdFrame frame;
  frame.depth_m = cv::Mat_<float>(10, 40, 1.5F);
  frame.color_rgb = cv::Mat_<cv::Vec3b>(10, 40, cv::Vec3b(9, 9, 9));
  const RgbdFrame wiped = spoil(frame, {0, 5, Damage::kWiped});
  EXPECT_EQ(wiped.utime, 5);
  EXPECT_EQ(wiped_pixels(wiped.depth_m), 400);
  EXPECT_EQ(cv::countNonZero(wiped.color_rgb.reshape(1)), 0);
  for (const int number : {0, 1}) {
    const RgbdFrame cut = spoil(frame, {number, 5, Damage::kCutOff});
    EXPECT_EQ(wiped_pixels(cut.depth_m), 300);
    EXPECT_EQ(cv::countNonZero(cut.color_rgb.reshape(1)), 300);
    EXPECT_EQ(std::isnan(cut.depth_m(0, 0)), number == 0);  // the sides alternate
  }
  EXPECT_EQ(wiped_pixels(frame.depth_m), 0);
  EXPECT_EQ(cv::countNonZero(frame.color_rgb.reshape(1)), 1200);
}

TEST(RecoveryDisturbance, NamesTheDisturbancesThereAre) {
  try {
    plan_disturbance("earthquake", kFrames, kPeriod_us);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("every-10"));
  }
}

}  // namespace
}  // namespace kintsugi::mapper::bench
