#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapper/synthetic/render/sensor_model.hpp"
#include "mapper/synthetic/rooms/scenes.hpp"

namespace kintsugi::synthetic {
namespace {

using Eigen::Vector3d;

/// A wall at depth z that fills the picture and faces the camera.
RenderedFrame flat_wall(double z_m) {
  const Intrinsics camera = default_intrinsics();
  const cv::Size size(camera.width, camera.height);
  return {Pose::Identity(),
          camera,
          cv::Mat_<float>(size, static_cast<float>(z_m)),
          cv::Mat_<cv::Vec3b>(size, cv::Vec3b(0, 0, 0)),
          cv::Mat_<cv::Vec3f>(size, cv::Vec3f(0, 0, -1)),
          cv::Mat_<std::uint16_t>(size, 1)};
}

bool same(const cv::Mat_<std::uint16_t>& a, const cv::Mat_<std::uint16_t>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

TEST(SensorModel, WithoutNoiseDepthIsRoundedToMillimetresWithinRange) {
  const SensorModel sensor({.noise = false});
  EXPECT_EQ(sensor.apply(flat_wall(1.2344), 0)(7, 9), 1234);
  EXPECT_EQ(sensor.apply(flat_wall(0.399), 0)(7, 9), 0);
  EXPECT_EQ(sensor.apply(flat_wall(5.001), 0)(7, 9), 0);
  EXPECT_EQ(sensor.apply(flat_wall(std::numeric_limits<double>::quiet_NaN()), 0)(7, 9), 0);
}

// Over n = 307,200 independent pixels the mean has a standard error of sigma / sqrt(n) and the
// standard deviation one of sigma / sqrt(2 n), a thousandth: five of them is 0.7 %. Rounding to
// millimetres adds a variance of (1 mm)^2 / 12.
TEST(SensorModel, NoiseHasTheStatedMeanAndDeviation) {
  const SensorModel sensor({.disparity_step_px = 0});
  for (double z_m : {0.8, 1.5, 3.0}) {
    const cv::Mat_<std::uint16_t> depth_mm = sensor.apply(flat_wall(z_m), 3);
    double sum = 0;
    double sum_of_squares = 0;
    for (std::uint16_t value : depth_mm) {
      const double error_m = 1e-3 * value - z_m;
      sum += error_m;
      sum_of_squares += error_m * error_m;
    }
    const double n = static_cast<double>(depth_mm.total());
    const double sigma_m = 0.0012 + 0.0019 * (z_m - 0.4) * (z_m - 0.4);
    const double expected_m = std::sqrt(sigma_m * sigma_m + 1e-6 / 12);
    EXPECT_NEAR(sensor.sigma_m(z_m), sigma_m, 1e-12);
    EXPECT_NEAR(sum / n, 0.0, 5 * expected_m / std::sqrt(n));
    EXPECT_NEAR(std::sqrt(sum_of_squares / n), expected_m, 0.007 * expected_m);
  }
}

TEST(SensorModel, NeighbouringPixelsAndFramesAreIndependent) {
  constexpr double kMaxCorrelation = 5 / 554.0;  // five standard errors, 1 / sqrt(307,200)
  const SensorModel sensor({.disparity_step_px = 0});
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

TEST(SensorModel, DisparityComesInStepsOfAnEighthPixel) {
  const SensorModel sensor({});
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

TEST(SensorModel, PixelsAtDepthEdgesAreLostAsOftenAsStated) {
  RenderedFrame frame = flat_wall(1.0);
  frame.depth_m(cv::Rect(320, 0, 320, 480)) = 1.5F;
  const SensorModel sensor({.edge_loss_probability = 0.6});
  const cv::Mat_<std::uint16_t> depth_mm = sensor.apply(frame, 0);
  int lost = 0;
  for (int v = 0; v < 480; ++v) {
    EXPECT_NE(depth_mm(v, 318), 0);
    EXPECT_NE(depth_mm(v, 321), 0);
    lost += (depth_mm(v, 319) == 0 ? 1 : 0) + (depth_mm(v, 320) == 0 ? 1 : 0);
  }
  EXPECT_NEAR(lost, 0.6 * 960, 5 * std::sqrt(960 * 0.6 * 0.4));  // five standard deviations
}

TEST(SensorModel, GrazingSurfacesAreLost) {
  const SensorModel sensor({});
  for (double incidence_deg : {70.0, 79.0, 81.0, 89.0}) {
    RenderedFrame frame = flat_wall(1.0);
    const double a = incidence_deg * std::acos(-1.0) / 180;
    frame.normals_W =
        cv::Vec3f(0, static_cast<float>(std::sin(a)), static_cast<float>(-std::cos(a)));
    const int value = sensor.apply(frame, 0)(240, 320);  // its ray is along z, to 0.1 degrees
    EXPECT_EQ(value == 0, incidence_deg > 80) << incidence_deg;
  }
}

TEST(SensorModel, FrameIsTheSameInAnyOrderAndOnAnyNumberOfThreads) {
  const SensorModel sensor({.seed = 5});
  const cv::Mat_<std::uint16_t> first = sensor.apply(flat_wall(2), 42);
  EXPECT_FALSE(same(first, sensor.apply(flat_wall(2), 41)));
  EXPECT_FALSE(same(first, SensorModel({.seed = 6}).apply(flat_wall(2), 42)));
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_TRUE(same(first, sensor.apply(flat_wall(2), 42)));
}

TEST(SensorModel, BadConfigurationIsRefused) {
  EXPECT_THROW(SensorModel({.min_depth_m = 0}), std::invalid_argument);
  EXPECT_THROW(SensorModel({.max_depth_m = 70}), std::invalid_argument);
  EXPECT_THROW(SensorModel({.sigma_base_m = -1}), std::invalid_argument);
  EXPECT_THROW(SensorModel({.edge_loss_probability = 1.1}), std::invalid_argument);
  EXPECT_THROW(SensorModel({.max_incidence_rad = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::synthetic
