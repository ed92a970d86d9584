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

// Near the camera the voxels limit how well a right pose fits, far away the noise.
TEST(LossRule, FindsResidualsTooLargeOnlyInVoxelsAndInNoise) {
  const LossRule rule = settled();
  RegistrationQuality quality = good();
  quality.rms_m = 1.7 * quality.voxel_m;
  quality.rms_sigmas = 2.1;
  EXPECT_EQ(rule.judge(quality), std::nullopt);
  quality.rms_m = 1.5 * quality.voxel_m;
  quality.rms_sigmas = 2.3;
  EXPECT_EQ(rule.judge(quality), std::nullopt);
  quality.rms_m = 1.7 * quality.voxel_m;
  EXPECT_EQ(rule.judge(quality), LossReason::kLargeResidual);
  quality.voxel_m *= 2.0;  // of a coarser map
  EXPECT_EQ(rule.judge(quality), std::nullopt);
}

TEST(LossRule, FindsPosesUncertainOnlyInVoxelsAndInNoise) {
  const LossRule rule = settled();
  RegistrationQuality quality = good();
  quality.sigma_m = 2.4 * quality.voxel_m;
  EXPECT_EQ(rule.judge(quality), LossReason::kUncertain);
  quality.noise_m = 1.01 * quality.sigma_m;
  EXPECT_EQ(rule.judge(quality), std::nullopt);
  quality.noise_m = 0.99 * quality.sigma_m;
  EXPECT_EQ(rule.judge(quality), LossReason::kUncertain);
}

/// Has accepted 400 frames with these shares of points behind and in front of surfaces.
LossRule used_to(double behind_share, double in_front_share, bool accepted = true) {
  LossRule rule({});
  RegistrationQuality usual = good();
  usual.behind_share = behind_share;
  usual.in_front_share = in_front_share;
  for (int i = 0; i < 400; ++i) rule.remember(usual, accepted);
  return rule;
}

/// The largest share, in steps of 1 %, with which a registration is accepted.
template <typename Judge>
double largest_accepted(double RegistrationQuality::*share, const Judge& judge) {
  RegistrationQuality quality = good();
  while (quality.*share < 1.0 && !judge(quality)) quality.*share += 0.01;
  return quality.*share - 0.01;
}

TEST(LossRule, AllowsWhatIsUsualOfTheCamera) {
  struct Case {
    double usual;
    double raised_by;
  };
  // Up to max_usual_share, 0.2.
  for (const auto& [usual, raised_by] : {Case{0.0, 0.0}, Case{0.1, 0.1}, Case{0.6, 0.2}}) {
    const LossRule rule = used_to(usual, usual);
    const auto judge = [&](const auto& quality) { return rule.judge(quality); };
    const auto judge_anew = [&](const auto& quality) { return rule.judge_found_anew(quality); };
    const LossRule::Config config;
    constexpr double kStep = 0.0101;
    for (double RegistrationQuality::*share :
         {&RegistrationQuality::behind_share, &RegistrationQuality::in_front_share}) {
      const bool is_behind = share == &RegistrationQuality::behind_share;
      const auto limit = [&](const Evidence& needed) {
        return is_behind ? needed.max_behind_share : needed.max_in_front_share;
      };
      EXPECT_NEAR(largest_accepted(share, judge), limit(config.following) + raised_by, kStep);
      EXPECT_NEAR(largest_accepted(share, judge_anew), limit(config.found_anew) + raised_by, kStep);
    }
  }
}

TEST(LossRule, DoesNotGetUsedToWhatItRejects) {
  const LossRule rule = used_to(0.6, 0.6, false);
  RegistrationQuality quality = good();
  quality.behind_share = 0.21;
  EXPECT_EQ(rule.judge(quality), LossReason::kThroughSurface);
  quality = good();
  quality.in_front_share = 0.41;
  EXPECT_EQ(rule.judge(quality), LossReason::kBeforeSurface);
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

// Of good() a fifth are outliers, and residuals are as large as the noise; 1.5 times that is
// unusual.
TEST(LossRule, KnowsWhatFitsWorseThanUsual) {
  RegistrationQuality quality = good();
  quality.inlier_share = 0.71;
  EXPECT_FALSE(settled().fits_worse_than_usual(quality));
  quality.inlier_share = 0.69;
  EXPECT_TRUE(settled().fits_worse_than_usual(quality));
  EXPECT_FALSE(LossRule({}).fits_worse_than_usual(quality)) << "nothing is usual yet";
  RegistrationQuality large_residuals = good();
  large_residuals.rms_sigmas = 1.4;
  EXPECT_FALSE(settled().fits_worse_than_usual(large_residuals));
  large_residuals.rms_sigmas = 1.6;
  EXPECT_TRUE(settled().fits_worse_than_usual(large_residuals));

  LossRule rule({});
  rule.remember(quality, false);
  EXPECT_FALSE(rule.fits_worse_than_usual(quality)) << "what is rejected says nothing";
  rule.remember(good(), true);
  EXPECT_TRUE(rule.fits_worse_than_usual(quality));
  for (int i = 0; i < 100; ++i) rule.remember(quality, true);
  EXPECT_FALSE(rule.fits_worse_than_usual(quality)) << "by now it is usual";
}

TEST(LossRule, DoesNotTakeAFrameThatWasNotRegisteredForTheUsualFit) {
  LossRule rule({});
  rule.remember({.covered_share = 0.9}, true);  // a start
  rule.remember(good(), true);
  EXPECT_FALSE(rule.fits_worse_than_usual(good()));
  RegistrationQuality quality = good();
  quality.inlier_share = 0.69;
  EXPECT_TRUE(rule.fits_worse_than_usual(quality));
}

// Of good() a fifth are outliers, and residuals are as large as the noise.
TEST(LossRule, BelievesNoPoseFoundAnewThatFitsMuchWorseThanUsual) {
  LossRule rule({});
  RegistrationQuality quality = good();
  quality.inlier_share = 0.59;
  quality.rms_sigmas = 2.1;
  EXPECT_EQ(rule.judge_found_anew(quality), std::nullopt) << "nothing is usual yet";
  for (int i = 0; i < 20; ++i) rule.remember(good(), true);
  EXPECT_EQ(rule.judge_found_anew(quality), LossReason::kMuchWorseThanUsual);
  EXPECT_EQ(rule.judge(quality), std::nullopt) << "the motion speaks for it";
  quality.inlier_share = 0.61;
  EXPECT_EQ(rule.judge_found_anew(quality), std::nullopt) << "residuals alone";
  quality.inlier_share = 0.59;
  quality.rms_sigmas = 1.9;
  EXPECT_EQ(rule.judge_found_anew(quality), std::nullopt) << "outliers alone";
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
