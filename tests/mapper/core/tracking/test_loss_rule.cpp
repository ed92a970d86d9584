#include <gtest/gtest.h>

#include "mapper/core/tracking/loss_rule.hpp"

namespace kintsugi::mapper {
namespace {

RegistrationQuality good() {
  RegistrationQuality quality;
  quality.covered_share = 0.9;
  quality.overlap_share = 0.85;
  quality.inlier_share = 0.8;
  quality.voxel_m = 4.5 / 512;
  quality.noise_m = 0.004;
  quality.rms_m = 0.004;
  quality.rms_sigmas = 1.0;
  quality.sigma_m = 0.003;
  quality.solved = true;
  return quality;
}

/// Past its grace period, used to a view that is nearly all valid.
LossRule settled() {
  LossRule rule({});
  for (int i = 0; i < 20; ++i) rule.remember(good(), true);
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
  quality.overlap_share = 0.019;
  EXPECT_EQ(rule.judge(quality), LossReason::kTooLittleOverlap);
  quality = good();
  quality.inlier_share = 0.29;
  EXPECT_EQ(rule.judge(quality), LossReason::kTooFewInliers);
  quality = good();
  quality.behind_share = 0.21;
  EXPECT_EQ(rule.judge(quality), LossReason::kThroughSurface);
  quality = good();
  quality.in_front_share = 0.41;
  EXPECT_EQ(rule.judge(quality), LossReason::kBeforeSurface);
  quality = good();
  quality.rms_m = 0.0141;
  quality.rms_sigmas = 2.3;
  EXPECT_EQ(rule.judge(quality), LossReason::kLargeResidual);
  quality = good();
  quality.sigma_m = 0.021;
  EXPECT_EQ(rule.judge(quality), LossReason::kUncertain);
  quality = good();
  quality.undetermined = 1;
  EXPECT_EQ(rule.judge(quality), LossReason::kUndetermined);
}

TEST(LossRule, DoesNotMindThatMostOfTheViewIsNew) {
  RegistrationQuality quality = good();
  quality.overlap_share = 0.28;
  EXPECT_EQ(settled().judge(quality), std::nullopt);
}

TEST(LossRule, AsksMoreOfAPoseFoundAnew) {
  const LossRule rule = settled();
  EXPECT_EQ(rule.judge_found_anew(good()), std::nullopt);
  for (double RegistrationQuality::*share :
       {&RegistrationQuality::behind_share, &RegistrationQuality::in_front_share}) {
    RegistrationQuality quality = good();
    quality.*share = 0.18;
    EXPECT_EQ(rule.judge(quality), std::nullopt);
    EXPECT_NE(rule.judge_found_anew(quality), std::nullopt);
  }
  for (const auto& [share, value] : {std::pair{&RegistrationQuality::overlap_share, 0.15},
                                     {&RegistrationQuality::inlier_share, 0.35}}) {
    RegistrationQuality quality = good();
    quality.*share = value;
    EXPECT_EQ(rule.judge(quality), std::nullopt);
    EXPECT_NE(rule.judge_found_anew(quality), std::nullopt);
  }
}

TEST(LossRule, ForgivesFewInliersWhileTheModelIsThin) {
  LossRule rule({});
  RegistrationQuality quality = good();
  quality.inlier_share = 0.2;
  for (int i = 0; i < LossRule::Config{}.grace_frames; ++i) {
    EXPECT_EQ(rule.judge(quality), std::nullopt) << i;
    rule.remember(quality, true);
  }
  EXPECT_EQ(rule.judge(quality), LossReason::kTooFewInliers);
}

TEST(LossRule, GetsUsedToAViewThatStaysSmall) {
  LossRule rule = settled();
  RegistrationQuality quality = good();
  quality.covered_share = 0.25;
  int frames = 0;
  while (rule.judge(quality) && frames < 100) {
    rule.remember(quality, false);
    ++frames;
  }
  // 0.25 >= 0.6 * 0.9 * 0.9^n from n = 8 on.
  EXPECT_EQ(frames, 8);
}

TEST(LossRule, RefusesSettingsOutOfRange) {
  LossRule::Config config;
  config.following.min_inlier_share = 1.5;
  try {
    LossRule rule(config);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "following.min_inlier_share is 1.5, must be within [0, 1]");
  }
}

}  // namespace
}  // namespace kintsugi::mapper
