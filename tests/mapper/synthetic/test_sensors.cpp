#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapper/synthetic/sensors/clean_sensor.hpp"
#include "mapper/synthetic/sensors/noise_fields.hpp"
#include "mapper/synthetic/sensors/sensors.hpp"
#include "tests/mapper/synthetic/pictures.hpp"

namespace kintsugi::synthetic {
namespace {

using testing::HasSubstr;

TEST(CleanSensor, DepthIsRoundedToMillimetresWithinRange) {
  const CleanSensor sensor({.range = {.min_m = 0.4, .max_m = 5.0}});
  EXPECT_EQ(sensor.apply(flat_wall(1.2344), 0)(7, 9), 1234);
  EXPECT_EQ(sensor.apply(flat_wall(0.399), 0)(7, 9), 0);
  EXPECT_EQ(sensor.apply(flat_wall(5.001), 0)(7, 9), 0);
  EXPECT_EQ(sensor.apply(flat_wall(std::numeric_limits<double>::quiet_NaN()), 0)(7, 9), 0);
}

TEST(Sensors, WithoutNoiseDepthIsTrueWithinTheRangeOfTheSensor) {
  for (const std::string& name : sensor_names()) {
    const auto noisy = make_sensor({.name = name});
    const auto quiet = make_sensor({.name = name, .noise = false});
    EXPECT_EQ(quiet->intrinsics(), noisy->intrinsics()) << name;
    EXPECT_EQ(quiet->apply(flat_wall(2.3456), 0)(7, 9), 2346) << name;
    EXPECT_EQ(quiet->apply(flat_wall(0.9 * noisy->range().min_m), 0)(7, 9), 0) << name;
    EXPECT_EQ(quiet->apply(flat_wall(1.1 * noisy->range().max_m), 0)(7, 9), 0) << name;
  }
}

TEST(Sensors, FrameIsTheSameInAnyOrderAndOnAnyNumberOfThreads) {
  for (const std::string& name : sensor_names()) {
    if (name == "clean") continue;
    const auto sensor = make_sensor({.name = name, .seed = 5});
    const RenderedFrame frame = two_walls(2.0, 1.5, sensor->intrinsics());
    const cv::Mat_<std::uint16_t> first = sensor->apply(frame, 42);
    EXPECT_FALSE(same(first, sensor->apply(frame, 41))) << name;
    EXPECT_FALSE(same(first, make_sensor({.name = name, .seed = 6})->apply(frame, 42))) << name;
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_TRUE(same(first, sensor->apply(frame, 42))) << name;
  }
}

TEST(Sensors, PixelsWithoutSurfaceAreLost) {
  for (const std::string& name : sensor_names()) {
    const auto sensor = make_sensor({.name = name});
    const RenderedFrame frame =
        two_walls(std::numeric_limits<double>::quiet_NaN(), 1.5, sensor->intrinsics());
    const cv::Mat_<std::uint16_t> depth_mm = sensor->apply(frame, 0);
    const cv::Rect left(0, 0, depth_mm.cols / 2, depth_mm.rows);
    EXPECT_EQ(cv::countNonZero(depth_mm(left)), 0) << name;
    EXPECT_GT(cv::countNonZero(depth_mm), 0) << name;
  }
}

TEST(Sensors, UnknownNameSaysWhatThereIs) {
  try {
    (void)make_sensor({.name = "sonar"});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("sonar"));
    for (const std::string& name : sensor_names()) EXPECT_THAT(error.what(), HasSubstr(name));
  }
}

// 900 seeds: the variance of a mean of squares of n independent normal numbers is 2 / n, so five
// standard errors are 5 sqrt(2 / 900) = 0.24.
TEST(GridNoise, HasVarianceOneAtNodesAndBetweenThem) {
  for (const double u : {0.0, 3.0, 6.0, 11.0}) {
    double squares = 0;
    double beside = 0;
    for (std::uint32_t seed = 0; seed < 900; ++seed) {
      const GridNoise noise(12, seed);
      squares += noise.at(6.0, u) * noise.at(6.0, u);
      beside += noise.at(6.0, u) * noise.at(6.0, u + 24.0);  // two cells: independent
    }
    EXPECT_NEAR(squares / 900, 1.0, 0.24) << u;
    EXPECT_NEAR(beside / 900, 0.0, 0.17) << u;
  }
}

TEST(Patches, CoverTheirShare) {
  constexpr int kPoints = 40;  // in each direction, half a metre apart: two patches
  for (const double share : {0.1, 0.25, 0.6}) {
    const Patches patches(0.25, share, 7);
    int within = 0;
    for (int x = 0; x < kPoints; ++x) {
      for (int y = 0; y < kPoints; ++y) {
        for (int z = 0; z < kPoints; ++z) {
          const Eigen::Vector3f p_W =
              0.51F * Eigen::Vector3i(x - 20, y, z).cast<float>() - Eigen::Vector3f::Ones();
          within += patches.depth_within(p_W) > 0.0F ? 1 : 0;
        }
      }
    }
    EXPECT_NEAR(within / std::pow(kPoints, 3), share, 0.02) << share;
  }
}

}  // namespace
}  // namespace kintsugi::synthetic
