#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "mapper/core/frame/local_noise.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kImages = 60;

/// A wall that turns away to the right: 1 m at the left border, `right_m` at the right one.
cv::Mat_<float> slanted_wall(const Intrinsics& camera, float left_m, float right_m) {
  cv::Mat_<float> depth_m(camera.height, camera.width);
  for (int u = 0; u < camera.width; ++u) {
    const auto share = static_cast<float>(u) / static_cast<float>(camera.width - 1);
    depth_m.col(u).setTo(1.0F / ((1.0F - share) / left_m + share / right_m));
  }
  return depth_m;
}

cv::Mat_<float> standard_normal(const cv::Size& size, cv::RNG& random) {
  cv::Mat_<float> noise(size);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
  return noise;
}

TEST(LocalNoise, OfIndependentErrorsIsTheirDeviation) {
  const cv::Mat_<float> wall_m = slanted_wall(testing::test_camera(), 1.0F, 4.0F);
  for (const DepthNoise& truth :
       {DepthNoise{.base_m = 0.01, .share = 0.0, .growth_per_m = 0.0},
        DepthNoise{.base_m = 0.001, .share = 0.0, .growth_per_m = 0.004}}) {
    LocalNoiseEstimator estimator;
    cv::RNG random(1);
    for (int i = 0; i < kImages; ++i) {
      cv::Mat_<float> depth_m = standard_normal(wall_m.size(), random);
      for (int v = 0; v < wall_m.rows; ++v) {
        for (int u = 0; u < wall_m.cols; ++u) {
          depth_m(v, u) *= static_cast<float>(truth.sigma_m(wall_m(v, u)));
        }
      }
      estimator.add(depth_m + wall_m);
    }
    for (const double z_m : {1.2, 2.0, 3.5}) {
      const double sigma_m = truth.sigma_m(z_m);
      EXPECT_NEAR(estimator.noise().sigma_m(z_m), sigma_m, 0.1 * sigma_m) << z_m << " m";
    }
  }
}

TEST(LocalNoise, LearnsFromTheFirstImage) {
  cv::RNG random(1);
  LocalNoiseEstimator estimator;
  estimator.add(2.0F + 0.03F * standard_normal({320, 240}, random));
  EXPECT_NEAR(estimator.noise().sigma_m(2.0), 0.03, 0.1 * 0.03);
}

TEST(LocalNoise, OfErrorsThatManyPixelsShareIsLittle) {
  cv::RNG random(1);
  LocalNoiseEstimator estimator;
  for (int i = 0; i < kImages; ++i) {
    cv::Mat_<float> error = standard_normal({320, 240}, random);
    cv::GaussianBlur(error, error, {}, 8.0);
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(error, mean, deviation);
    estimator.add(2.0F + error * (0.01 / deviation[0]));
  }
  EXPECT_LT(estimator.noise().sigma_m(2.0), 0.001);
}

TEST(LocalNoise, OfExactDepthIsATenthOfTheStart) {
  LocalNoiseEstimator estimator;
  for (int i = 0; i < kImages; ++i) {
    estimator.add(slanted_wall(testing::test_camera(), 1.0F, 4.0F));
  }
  for (const double z_m : {1.2, 2.0, 3.5}) {
    const double least_m = 0.1 * DepthNoise().sigma_m(z_m);
    EXPECT_GT(estimator.noise().sigma_m(z_m), 0.9 * least_m) << z_m;
    EXPECT_LT(estimator.noise().sigma_m(z_m), 1.6 * least_m) << z_m;
  }
}

// A camera that matches its pattern in steps of an eighth of a pixel gives most neighbours of a
// wall the same depth.
TEST(LocalNoise, OfDisparityStepsIsNotZero) {
  constexpr double kDisparity_m = 45.0;  // depth times disparity: 600 pixels at 75 mm
  constexpr double kStep_px = 0.125;
  for (const double wall_m : {2.0, 3.0}) {
    for (const double noise_steps : {0.2, 0.35}) {
      cv::RNG random(1);
      LocalNoiseEstimator estimator;
      for (int i = 0; i < kImages; ++i) {
        cv::Mat_<float> depth_m = standard_normal({320, 240}, random);
        for (int v = 0; v < depth_m.rows; ++v) {
          for (int u = 0; u < depth_m.cols; ++u) {
            // The wall leans back a little, so that all parts of a step occur.
            const double true_m = wall_m + 4e-4 * u + 2e-4 * v;
            const double steps = kDisparity_m / true_m / kStep_px + noise_steps * depth_m(v, u);
            depth_m(v, u) = static_cast<float>(kDisparity_m / (kStep_px * std::round(steps)));
          }
        }
        estimator.add(depth_m);
      }
      const double step_m = wall_m * wall_m * kStep_px / kDisparity_m;
      const double noise_m = step_m * std::sqrt(noise_steps * noise_steps + 1.0 / 12.0);
      EXPECT_GT(estimator.noise().sigma_m(wall_m), 0.5 * noise_m) << wall_m << ' ' << noise_steps;
      EXPECT_LT(estimator.noise().sigma_m(wall_m), 1.5 * noise_m) << wall_m << ' ' << noise_steps;
    }
  }
}

// --- Mixed pixels ---

constexpr DepthNoise kFine{.base_m = 0.001, .share = 0.0, .growth_per_m = 0.0005};

/// A near surface, columns 100 to 199, before a wall.
cv::Mat_<float> post_before_wall() {
  cv::Mat_<float> depth_m(240, 320, 2.0F);
  depth_m.colRange(100, 200).setTo(1.0F);
  return depth_m;
}

int num_invalid(const cv::Mat_<float>& depth_m) {
  return static_cast<int>(
      std::count_if(depth_m.begin(), depth_m.end(), [](float z) { return std::isnan(z); }));
}

TEST(MixedPixels, BetweenTwoSurfacesAreRemoved) {
  const cv::Mat_<float> exact_m = post_before_wall();
  for (const bool in_rows : {true, false}) {
    cv::Mat_<float> depth_m = exact_m.clone();
    depth_m.col(99).setTo(1.4F);
    depth_m.col(200).setTo(1.7F);
    Intrinsics camera = testing::test_camera();
    if (!in_rows) {
      depth_m = depth_m.t();
      std::swap(camera.width, camera.height);
    }
    const cv::Mat_<float> before = depth_m.clone();
    cv::Mat_<float> clean = without_mixed_pixels(depth_m, camera, kFine);
    EXPECT_EQ(cv::norm(before, depth_m, cv::NORM_INF), 0.0) << "the caller's image is not touched";
    if (!in_rows) clean = clean.t();
    for (int v = 1; v + 1 < clean.rows; ++v) {
      EXPECT_TRUE(std::isnan(clean(v, 99))) << v;
      EXPECT_TRUE(std::isnan(clean(v, 200))) << v;
      EXPECT_EQ(clean(v, 98), 2.0F);
      EXPECT_EQ(clean(v, 100), 1.0F);
      EXPECT_EQ(clean(v, 199), 1.0F);
      EXPECT_EQ(clean(v, 201), 2.0F);
    }
    EXPECT_LE(num_invalid(clean), 2 * clean.rows);
  }
}

TEST(MixedPixels, OnOneOfTheTwoSurfacesAreKept) {
  cv::Mat_<float> depth_m = post_before_wall();
  depth_m.col(99).setTo(1.995F);
  depth_m.col(200).setTo(1.005F);
  EXPECT_EQ(num_invalid(without_mixed_pixels(depth_m, testing::test_camera(), kFine)), 0);
}

TEST(MixedPixels, ThinObjectsAndGapsAreNone) {
  cv::Mat_<float> depth_m(240, 320, 2.0F);
  depth_m.col(50).setTo(1.0F);   // a wire
  depth_m.row(60).setTo(1.0F);   // another
  depth_m.col(150).setTo(3.0F);  // a gap
  depth_m.colRange(200, 202).setTo(1.0F);
  depth_m(100, 250) = 1.0F;
  EXPECT_EQ(num_invalid(without_mixed_pixels(depth_m, testing::test_camera(), kFine)), 0);
}

TEST(MixedPixels, SlantedWallsAreNone) {
  // Up to 75 degrees from the image: a depth of 4 m within a metre of width.
  const Intrinsics camera = testing::test_camera();
  EXPECT_EQ(num_invalid(without_mixed_pixels(slanted_wall(camera, 1.0F, 8.0F), camera, kFine)), 0);
  const cv::Mat_<float> room_m = testing::render_depth(testing::looking_at_the_crate(), camera);
  EXPECT_EQ(num_invalid(without_mixed_pixels(room_m, camera, kFine)), 0);
}

TEST(MixedPixels, NoiseMakesNone) {
  cv::RNG random(1);
  const cv::Mat_<float> depth_m = 3.0F + 0.02F * standard_normal({320, 240}, random);
  const DepthNoise noise{.base_m = 0.02, .share = 0.0, .growth_per_m = 0.0};
  EXPECT_EQ(num_invalid(without_mixed_pixels(depth_m, testing::test_camera(), noise)), 0);
}

TEST(MixedPixels, InvalidNeighboursSayNothing) {
  cv::Mat_<float> depth_m = post_before_wall();
  depth_m.col(99).setTo(1.4F);
  depth_m.col(98).setTo(kNaN);
  const cv::Mat_<float> clean = without_mixed_pixels(depth_m, testing::test_camera(), kFine);
  EXPECT_EQ(num_invalid(clean), 240) << "those of column 98 only";
}

}  // namespace
}  // namespace kintsugi::mapper
