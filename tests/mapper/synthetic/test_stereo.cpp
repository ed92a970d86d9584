#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "mapper/synthetic/render/renderer.hpp"
#include "mapper/synthetic/rooms/scenes.hpp"
#include "mapper/synthetic/sensors/stereo.hpp"
#include "tests/mapper/synthetic/pictures.hpp"

namespace kintsugi::synthetic {
namespace {

constexpr double kDisparityTimesM = 615 * 0.050;

// Neighbours within a window of w pixels are correlated, so n pixels count as n / (4/9 w^2) in the
// variance (the sum of the squared correlations, (2/3 w)^2); of 300,000 pixels and w = 7 that is
// 13,800, and five standard errors of the deviation are 5 / sqrt(2 * 13,800) = 3 %.
TEST(Stereo, DeviationGrowsWithTheSquareOfDepth) {
  const Stereo sensor({.untextured_share = 0});
  for (const double z_m : {0.8, 1.75, 4.0}) {
    const ErrorStatistics errors =
        errors_about(z_m, sensor.apply(flat_wall(z_m, sensor.intrinsics()), 3));
    const double disparity_sigma_px = std::sqrt(0.08 * 0.08 + std::pow(1.0 / 32, 2) / 12);
    const double sigma_m = z_m * z_m * disparity_sigma_px / kDisparityTimesM;
    const double expected_m = std::sqrt(sigma_m * sigma_m + 1e-6 / 12);  // rounding
    // Sums over windows overlap: the mean has the standard error sigma w / sqrt(n).
    EXPECT_NEAR(errors.mean_m, 0.0, 5 * expected_m * 7 / std::sqrt(errors.count));
    EXPECT_NEAR(errors.deviation_m, expected_m, 0.03 * expected_m) << z_m;
  }
}

TEST(Stereo, ErrorsAreAlikeWithinAWindowAndUnrelatedBeyond) {
  constexpr int kWindow_px = 7;
  const double z_m = 2.0;
  const Stereo sensor({.disparity_step_px = 0, .untextured_share = 0});
  const cv::Mat_<std::uint16_t> depth_mm = sensor.apply(flat_wall(z_m, sensor.intrinsics()), 10);
  const auto correlation = [&](int dv, int du) {
    double product = 0;
    double square = 0;
    for (int v = 0; v + dv < 480; ++v) {
      for (int u = 40; u + du < 640; ++u) {
        const double a = 1e-3 * depth_mm(v, u) - z_m;
        product += a * (1e-3 * depth_mm(v + dv, u + du) - z_m);
        square += a * a;
      }
    }
    return product / square;
  };
  constexpr double kTolerance = 0.05;  // five standard errors, see above
  for (const int distance : {1, 3, 6}) {
    const double expected = 1.0 - static_cast<double>(distance) / kWindow_px;
    EXPECT_NEAR(correlation(0, distance), expected, kTolerance) << distance;
    EXPECT_NEAR(correlation(distance, 0), expected, kTolerance) << distance;
  }
  EXPECT_NEAR(correlation(3, 3), std::pow(1 - 3.0 / kWindow_px, 2), kTolerance);
  EXPECT_NEAR(correlation(0, 8), 0.0, kTolerance);
  EXPECT_NEAR(correlation(8, 0), 0.0, kTolerance);
}

TEST(Stereo, FramesAreIndependent) {
  const double z_m = 2.0;
  const Stereo sensor({.untextured_share = 0});
  const RenderedFrame wall = flat_wall(z_m, sensor.intrinsics());
  const cv::Mat_<std::uint16_t> a = sensor.apply(wall, 10);
  const cv::Mat_<std::uint16_t> b = sensor.apply(wall, 11);
  double product = 0;
  double square = 0;
  for (int v = 0; v < 480; ++v) {
    for (int u = 40; u < 640; ++u) {
      product += (1e-3 * a(v, u) - z_m) * (1e-3 * b(v, u) - z_m);
      square += std::pow(1e-3 * a(v, u) - z_m, 2);
    }
  }
  EXPECT_NEAR(product / square, 0.0, 0.05);
}

TEST(Stereo, WhatTheRightImageDoesNotShowIsLost) {
  const Stereo sensor({.edge_loss_probability = 0, .untextured_share = 0});
  // A wall at 2 m, and before its right half something at 1 m: its shadow is on its left and as
  // wide as the disparities differ, 15.4 pixels.
  const cv::Mat_<std::uint16_t> before = sensor.apply(two_walls(2.0, 1.0, sensor.intrinsics()), 0);
  // Before the left half: the right camera sees past it on its other side.
  const cv::Mat_<std::uint16_t> beyond = sensor.apply(two_walls(1.0, 2.0, sensor.intrinsics()), 0);
  const int shadow = static_cast<int>(std::floor(kDisparityTimesM * (1 / 1.0 - 1 / 2.0)));
  for (int u = 0; u < 640; ++u) {
    const bool left_of_right_image = u < kDisparityTimesM / 2.0;
    const bool in_shadow = u >= 320 - shadow && u < 320;
    EXPECT_EQ(before(240, u) == 0, left_of_right_image || in_shadow) << u;
    EXPECT_EQ(beyond(240, u) == 0, u < kDisparityTimesM / 1.0) << u;
  }
}

TEST(Stereo, WindowsAcrossAnEdgeAreLostAsOftenAsStated) {
  const Stereo sensor({.edge_loss_probability = 0.7, .untextured_share = 0});
  const cv::Mat_<std::uint16_t> depth_mm =
      sensor.apply(two_walls(1.0, 2.0, sensor.intrinsics()), 0);
  int lost = 0;
  for (int v = 0; v < 480; ++v) {
    // The edge is between 319 and 320: both are edge pixels, and windows reach 3 pixels to each
    // side.
    for (int u = 316; u < 324; ++u) lost += depth_mm(v, u) == 0 ? 1 : 0;
    EXPECT_NE(depth_mm(v, 315), 0);
    EXPECT_NE(depth_mm(v, 324), 0);
  }
  EXPECT_NEAR(lost, 0.7 * 8 * 480, 5 * std::sqrt(8 * 480 * 0.7 * 0.3));
}

TEST(Stereo, UntexturedPatchesStayWhereTheyAre) {
  const Stereo sensor({});
  RenderedFrame wall = flat_wall(2.0, sensor.intrinsics());
  const cv::Mat_<std::uint16_t> first = sensor.apply(wall, 0);
  const cv::Mat_<std::uint16_t> second = sensor.apply(wall, 1);
  const double moved_px = 40;
  wall.X_WC.translation().x() = moved_px * 2.0 / 615;
  const cv::Mat_<std::uint16_t> moved = sensor.apply(wall, 1);
  int lost = 0;
  int again = 0;
  int again_when_moved = 0;
  for (int v = 0; v < 480; ++v) {
    for (int u = 100; u < 640; ++u) {
      if (first(v, u) != 0) continue;
      ++lost;
      again += second(v, u) == 0 ? 1 : 0;
      again_when_moved += moved(v, u - 40) == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(again, 0.9 * lost);
  EXPECT_GT(again_when_moved, 0.9 * lost);
  EXPECT_LT(again, lost) << "their borders are ragged";
}

TEST(Stereo, AThirdToHalfOfARoomIsLost) {
  const Stereo sensor({});
  for (const char* name : {"office", "kitchen"}) {
    const auto [scene, path] = make_scene_with_path(name);
    double share = 0;
    for (const double t_s : {1.0, 4.0, 8.0}) {
      const RenderedFrame frame = render(scene, sensor.intrinsics(), path.X_WC(t_s));
      share += invalid_share(sensor.apply(frame, 0)) / 3;
    }
    EXPECT_GT(share, 0.33) << name;
    EXPECT_LT(share, 0.5) << name;
  }
}

TEST(Stereo, BadConfigurationIsRefused) {
  EXPECT_THROW(Stereo({.baseline_m = 0}), std::invalid_argument);
  EXPECT_THROW(Stereo({.sigma_disparity_px = -1}), std::invalid_argument);
  EXPECT_THROW(Stereo({.window_px = 6}), std::invalid_argument);
  EXPECT_THROW(Stereo({.untextured_share = 1.1}), std::invalid_argument);
  EXPECT_THROW(Stereo({.untextured_size_m = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::synthetic
