#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/core/frame/deviation_by_depth.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kMedian = 0.5;
constexpr double kErrorsOfStart = 1.0;
constexpr int kErrorsPerDepth = 500;
constexpr DepthNoise kStart;

// The fit's bins span a quarter of their depth, over which the steepest noise changes by a quarter
// up and down; what is left of that, and the scatter of a median of 5000 errors.
constexpr double kFit = 0.06;

/// Where the errors below are counted.
std::vector<double> counted_depths_m() {
  std::vector<double> depths_m;
  for (double z_m = 0.4; z_m < 7.0; z_m *= 1.02) depths_m.push_back(z_m);
  return depths_m;
}

/// Normally distributed errors, of which `gross_share` are replaced by `gross_m`.
DeviationByDepth counted(const DepthNoise& truth, double quantile, double gross_share = 0.0,
                         double gross_m = 0.0) {
  DeviationByDepth deviations(quantile);
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> share;
  for (const double z_m : counted_depths_m()) {
    for (int i = 0; i < kErrorsPerDepth; ++i) {
      const double error_m = std::abs(truth.sigma_m(z_m) * gauss(random));
      deviations.count(z_m, share(random) < gross_share ? gross_m : error_m);
    }
  }
  return deviations;
}

DepthNoise fitted(const DeviationByDepth& deviations) {
  return deviations.fit(kStart, kErrorsOfStart, 0.0);
}

void expect_deviation(const DepthNoise& noise, const DepthNoise& truth, double factor = 1.0) {
  for (const double z_m : {0.5, 1.0, 2.0, 3.0, 4.5, 6.0}) {
    const double expected_m = factor * truth.sigma_m(z_m);
    EXPECT_NEAR(noise.sigma_m(z_m), expected_m, kFit * expected_m) << z_m << " m";
  }
}

TEST(DeviationByDepth, RecoversEachTermAndTheirSum) {
  constexpr double kBase_m = 0.012;
  constexpr double kShare = 0.01;
  constexpr double kGrowth_per_m = 0.004;
  for (const double quantile : {0.5, 0.8}) {
    SCOPED_TRACE(quantile);
    const DepthNoise base{.base_m = kBase_m, .share = 0.0, .growth_per_m = 0.0};
    const DepthNoise of_base = fitted(counted(base, quantile));
    expect_deviation(of_base, base);
    EXPECT_NEAR(of_base.base_m, kBase_m, kFit * kBase_m);

    const DepthNoise share{.base_m = 0.0, .share = kShare, .growth_per_m = 0.0};
    const DepthNoise of_share = fitted(counted(share, quantile));
    expect_deviation(of_share, share);
    EXPECT_NEAR(of_share.share, kShare, kFit * kShare);

    const DepthNoise growth{.base_m = 0.0, .share = 0.0, .growth_per_m = kGrowth_per_m};
    const DepthNoise of_growth = fitted(counted(growth, quantile));
    expect_deviation(of_growth, growth);
    EXPECT_NEAR(of_growth.growth_per_m, kGrowth_per_m, kFit * kGrowth_per_m);

    const DepthNoise all{.base_m = kBase_m, .share = kShare, .growth_per_m = kGrowth_per_m};
    expect_deviation(fitted(counted(all, quantile)), all);
  }
}

// Where a third of all errors is grossly wrong, the median of all is the 75 % quantile of the
// others, 1.150 deviations instead of 0.674; where a tenth is, 0.765.
TEST(DeviationByDepth, IsNotCarriedAwayByGrossErrorsHoweverLarge) {
  const DepthNoise truth{.base_m = 0.01, .share = 0.0, .growth_per_m = 0.0};
  for (const double gross_m : {0.1, 10.0}) {
    expect_deviation(fitted(counted(truth, kMedian, 0.1, gross_m)), truth, 0.765 / 0.674);
    expect_deviation(fitted(counted(truth, kMedian, 1.0 / 3.0, gross_m)), truth, 1.150 / 0.674);
  }
}

TEST(DeviationByDepth, IsTheStartWhereNothingWasCounted) {
  for (const DepthNoise& start :
       {DepthNoise(), DepthNoise{.base_m = 0.005, .share = 0.015, .growth_per_m = 0.001}}) {
    const DepthNoise noise = DeviationByDepth(kMedian).fit(start, kErrorsOfStart, 0.0);
    EXPECT_NEAR(noise.base_m, start.base_m, 1e-6);
    EXPECT_NEAR(noise.share, start.share, 1e-6);
    EXPECT_NEAR(noise.growth_per_m, start.growth_per_m, 1e-6);
  }
}

TEST(DeviationByDepth, LeavesTheStartBehindAtTheDepthsThatWereCounted) {
  // Only about 2 m, three times the start.
  DeviationByDepth deviations(kMedian);
  std::mt19937 random(5);
  std::normal_distribution<double> gauss;
  const double sigma_m = 3.0 * kStart.sigma_m(2.0);
  for (int i = 0; i < 20'000; ++i) deviations.count(2.0, std::abs(sigma_m * gauss(random)));
  const DepthNoise noise = fitted(deviations);
  EXPECT_NEAR(noise.sigma_m(2.0), sigma_m, kFit * sigma_m);
  // Elsewhere it remains between the two, because the terms have to explain all depths.
  for (const double z_m : {0.7, 5.0}) {
    EXPECT_GT(noise.sigma_m(z_m), 0.9 * kStart.sigma_m(z_m)) << z_m;
    EXPECT_LT(noise.sigma_m(z_m), 3.3 * kStart.sigma_m(z_m)) << z_m;
  }
}

// The depths that a camera sees in a room; the start is a third to a seventh of the truth there.
TEST(DeviationByDepth, IsNotHeldBackByDepthsThatWereNotCounted) {
  const DepthNoise truth{.base_m = 0.0, .share = 0.02, .growth_per_m = 0.0};
  DeviationByDepth deviations(kMedian);
  std::mt19937 random(5);
  std::normal_distribution<double> gauss;
  int number = 0;
  for (double z_m = 1.0; z_m < 3.0; z_m *= 1.02) {
    for (int i = 0; i < kErrorsPerDepth; ++i, ++number) {
      deviations.count(z_m, std::abs(truth.sigma_m(z_m) * gauss(random)));
    }
  }
  const double per_bin = number / 5.0;
  const DepthNoise noise = deviations.fit(kStart, per_bin / 30.0, 0.0);
  for (const double z_m : {1.2, 2.0, 2.8}) {
    EXPECT_NEAR(noise.sigma_m(z_m), truth.sigma_m(z_m), 0.1 * truth.sigma_m(z_m)) << z_m << " m";
  }
}

TEST(DeviationByDepth, WeighsTheStartByItsErrors) {
  // As many errors as the start counts for: the mean of the variances.
  const DepthNoise start{.base_m = 0.01, .share = 0.0, .growth_per_m = 0.0};
  const DepthNoise truth{.base_m = 0.02, .share = 0.0, .growth_per_m = 0.0};
  DeviationByDepth deviations = counted(truth, kMedian);
  // The bins are a quarter wide, the counted depths 2 % apart: 11 or 12 of these in each.
  const double per_bin = 11.3 * kErrorsPerDepth;
  const double expected_m = std::sqrt(0.5 * (0.01 * 0.01 + 0.02 * 0.02));
  EXPECT_NEAR(deviations.fit(start, per_bin, 0.0).sigma_m(2.0), expected_m, 0.05 * expected_m);
}

TEST(DeviationByDepth, IsNoLessThanTheLeast) {
  DeviationByDepth exact(kMedian);
  for (const double z_m : counted_depths_m()) {
    for (int i = 0; i < kErrorsPerDepth; ++i) exact.count(z_m, 0.0);
  }
  expect_deviation(exact.fit(kStart, 1.0, 1.0), kStart);
  expect_deviation(exact.fit(kStart, 1.0, 0.5), kStart, 0.5);
}

TEST(DeviationByDepth, ForgetsWhatHasFaded) {
  const DepthNoise before{.base_m = 0.05, .share = 0.0, .growth_per_m = 0.0};
  DeviationByDepth deviations = counted(before, kMedian);
  deviations.fade(1e-3);
  const DepthNoise now{.base_m = 0.01, .share = 0.0, .growth_per_m = 0.0};
  std::mt19937 random(7);
  std::normal_distribution<double> gauss;
  for (const double z_m : counted_depths_m()) {
    for (int i = 0; i < kErrorsPerDepth; ++i) {
      deviations.count(z_m, std::abs(now.sigma_m(z_m) * gauss(random)));
    }
  }
  expect_deviation(fitted(deviations), now);
  deviations.fade(0.0);
  expect_deviation(fitted(deviations), kStart);
}

}  // namespace
}  // namespace kintsugi::mapper
