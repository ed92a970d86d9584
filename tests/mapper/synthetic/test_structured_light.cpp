#include <cmath>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "mapper/synthetic/sensors/structured_light.hpp"
#include "tests/mapper/synthetic/pictures.hpp"

namespace kintsugi::synthetic {
namespace {

// Over n = 307,200 independent pixels the mean has a standard error of sigma / sqrt(n) and the
// standard deviation one of sigma / sqrt(2 n), a thousandth: five of them is 0.7 %. Rounding to
// millimetres adds a variance of (1 mm)^2 / 12.
TEST(StructuredLight, NoiseHasTheStatedMeanAndDeviation) {
  const StructuredLight sensor({.disparity_step_px = 0});
  for (double z_m : {0.8, 1.5, 3.0}) {
    const ErrorStatistics errors = errors_about(z_m, sensor.apply(flat_wall(z_m), 3));
    const double sigma_m = 0.0012 + 0.0019 * (z_m - 0.4) * (z_m - 0.4);
    const double expected_m = std::sqrt(sigma_m * sigma_m + 1e-6 / 12);
    EXPECT_NEAR(sensor.sigma_m(z_m), sigma_m, 1e-12);
    EXPECT_EQ(errors.count, 307'200);
    EXPECT_NEAR(errors.mean_m, 0.0, 5 * expected_m / std::sqrt(errors.count));
    EXPECT_NEAR(errors.deviation_m, expected_m, 0.007 * expected_m);
  }
}

TEST(StructuredLight, NeighbouringPixelsAndFramesAreIndependent) {
  constexpr double kMaxCorrelation = 5 / 554.0;  // five standard errors, 1 / sqrt(307,200)
  const StructuredLight sensor({.disparity_step_px = 0});
  const double z_m = 2.0;
  const cv::Mat_<std::uint16_t> a = sensor.apply(flat_wall(z_m), 10);
  const cv::Mat_<std::uint16_t> b = sensor.apply(flat_wall(z_m), 11);
  const auto error = [&](const cv::Mat_<std::uint16_t>& depth, int v, int u) {
    return (1e-3 * depth(v, u) - z_m) / sensor.sigma_m(z_m);
  };
  double beside = 0;
  double below = 0;
  double next_frame = 0;
  for (int v = 1; v < 480; ++v) {
    for (int u = 1; u < 640; ++u) {
      beside += error(a, v, u) * error(a, v, u - 1);
      below += error(a, v, u) * error(a, v - 1, u);
      next_frame += error(a, v, u) * error(b, v, u);
    }
  }
  const double n = 479.0 * 639.0;
  EXPECT_LT(std::abs(beside / n), kMaxCorrelation);
  EXPECT_LT(std::abs(below / n), kMaxCorrelation);
  EXPECT_LT(std::abs(next_frame / n), kMaxCorrelation);
}

TEST(StructuredLight, DisparityComesInStepsOfAnEighthPixel) {
  const StructuredLight sensor({});
  const cv::Mat_<std::uint16_t> depth_mm = sensor.apply(flat_wall(2.0), 0);
  const double per_metre = 0.075 * 525 / 0.125;  // steps of disparity at 1 m
  std::set<std::uint16_t> possible;
  for (int step = 1; step < 2000; ++step) {
    possible.insert(static_cast<std::uint16_t>(std::lround(1000 * per_metre / step)));
  }
  std::set<std::uint16_t> seen(depth_mm.begin(), depth_mm.end());
  for (std::uint16_t value : seen) EXPECT_TRUE(possible.contains(value)) << value;
  EXPECT_GT(seen.size(), 3U);
}

TEST(StructuredLight, PixelsAtDepthEdgesAreLostAsOftenAsStated) {
  const RenderedFrame frame = two_walls(1.0, 1.5, default_intrinsics());
  const StructuredLight sensor({.edge_loss_probability = 0.6});
  const cv::Mat_<std::uint16_t> depth_mm = sensor.apply(frame, 0);
  int lost = 0;
  for (int v = 0; v < 480; ++v) {
    EXPECT_NE(depth_mm(v, 318), 0);
    EXPECT_NE(depth_mm(v, 321), 0);
    lost += (depth_mm(v, 319) == 0 ? 1 : 0) + (depth_mm(v, 320) == 0 ? 1 : 0);
  }
  EXPECT_NEAR(lost, 0.6 * 960, 5 * std::sqrt(960 * 0.6 * 0.4));  // five standard deviations
}

TEST(StructuredLight, GrazingSurfacesAreLost) {
  const StructuredLight sensor({});
  for (double incidence_deg : {70.0, 79.0, 81.0, 89.0}) {
    RenderedFrame frame = flat_wall(1.0);
    const double a = incidence_deg * std::acos(-1.0) / 180;
    frame.normals_W =
        cv::Vec3f(0, static_cast<float>(std::sin(a)), static_cast<float>(-std::cos(a)));
    const int value = sensor.apply(frame, 0)(240, 320);  // its ray is along z, to 0.1 degrees
    EXPECT_EQ(value == 0, incidence_deg > 80) << incidence_deg;
  }
}

TEST(StructuredLight, BadConfigurationIsRefused) {
  EXPECT_THROW(StructuredLight({.range = {.min_m = 0, .max_m = 5}}), std::invalid_argument);
  EXPECT_THROW(StructuredLight({.range = {.min_m = 0.4, .max_m = 70}}), std::invalid_argument);
  EXPECT_THROW(StructuredLight({.sigma_base_m = -1}), std::invalid_argument);
  EXPECT_THROW(StructuredLight({.edge_loss_probability = 1.1}), std::invalid_argument);
  EXPECT_THROW(StructuredLight({.max_incidence_rad = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::synthetic
