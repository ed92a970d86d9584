#include <gtest/gtest.h>

#include "mapper/core/loss_rule.hpp"

namespace kintsugi::mapper {
namespace {

RegistrationQuality good() {
  RegistrationQuality quality;
  quality.covered_share = 0.9;
  quality.overlap_share = 0.85;
  quality.inlier_share = 0.8;
  quality.rms_m = 0.004;
  quality.solved = true;
  return quality;
}

/// Past its grace period, used to a view that is nearly all valid.
LossRule settled() {
  LossRule rule({});
  for (int i = 0; i < 20; ++i) rule.remember(0.9, true);
  return rule;
}

TEST(LossRule, BelievesAGoodRegistration) { EXPECT_EQ(settled().judge(good()), std::nullopt); }

TEST(LossRule, NamesWhatIsWrong) {
  const LossRule rule = settled();
  RegistrationQuality quality = good();
  quality.covered_share = 0.019;
  EXPECT_EQ(rule.judge(quality), LossReason::kTooFewPixels);
  quality = good();
  quality.covered_share = 0.5;  // less than 0.6 of what was there
  EXPECT_EQ(rule.judge(quality), LossReason::kViewCutOff);
  quality = good();
  quality.solved = false;
  EXPECT_EQ(rule.judge(quality), LossReason::kNotSolved);
  quality = good();
  quality.inlier_share = 0.44;
  EXPECT_EQ(rule.judge(quality), LossReason::kTooFewInliers);
  quality = good();
  quality.rms_m = 0.0141;
  EXPECT_EQ(rule.judge(quality), LossReason::kLargeResidual);
}

TEST(LossRule, ForgivesFewInliersWhileTheModelIsThin) {
  LossRule rule({});
  RegistrationQuality quality = good();
  quality.inlier_share = 0.2;
  for (int i = 0; i < LossRule::Config{}.grace_frames; ++i) {
    EXPECT_EQ(rule.judge(quality), std::nullopt) << i;
    rule.remember(quality.covered_share, true);
  }
  EXPECT_EQ(rule.judge(quality), LossReason::kTooFewInliers);
}

TEST(LossRule, GetsUsedToAViewThatStaysSmall) {
  LossRule rule = settled();
  RegistrationQuality quality = good();
  quality.covered_share = 0.25;
  int frames = 0;
  while (rule.judge(quality) && frames < 100) {
    rule.remember(quality.covered_share, false);
    ++frames;
  }
  // 0.25 >= 0.6 * 0.9 * 0.9^n from n = 8 on.
  EXPECT_EQ(frames, 8);
}

TEST(LossRule, RefusesSettingsOutOfRange) {
  LossRule::Config config;
  config.min_inlier_share = 1.5;
  try {
    LossRule rule(config);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "min_inlier_share is 1.5, must be within [0, 1]");
  }
}

}  // namespace
}  // namespace kintsugi::mapper
