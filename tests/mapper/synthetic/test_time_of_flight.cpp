#include <cmath>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "mapper/synthetic/sensors/time_of_flight.hpp"
#include "tests/mapper/synthetic/pictures.hpp"

namespace kintsugi::synthetic {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// As flat_wall(), and its surface is turned away from every ray by the same angle.
RenderedFrame turned_wall(double z_m, double incidence_rad, const Intrinsics& camera) {
  RenderedFrame frame = flat_wall(z_m, camera);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray =
          Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1).normalized();
      const Eigen::Vector3d side = ray.cross(Eigen::Vector3d::UnitY()).normalized();
      const Eigen::Vector3d n = std::sin(incidence_rad) * side - std::cos(incidence_rad) * ray;
      frame.normals_W(v, u) = cv::Vec3f(static_cast<float>(n.x()), static_cast<float>(n.y()),
                                        static_cast<float>(n.z()));
    }
  }
  return frame;
}

// Fankhauser et al. 2015, in millimetres, worked out by hand.
TEST(TimeOfFlight, DeviationIsThatOfTheSource) {
  EXPECT_NEAR(TimeOfFlight::sigma_m(1.0, 0), 1.3e-3, 1e-9);
  EXPECT_NEAR(TimeOfFlight::sigma_m(2.0, 0), 1.7e-3, 1e-9);
  EXPECT_NEAR(TimeOfFlight::sigma_m(4.0, 0), 4.3e-3, 1e-9);
  EXPECT_NEAR(TimeOfFlight::sigma_m(4.0, std::numbers::pi / 4), 5.1e-3, 1e-9);
  EXPECT_NEAR(TimeOfFlight::sigma_m(4.0, std::numbers::pi / 3), 7.5e-3, 1e-9);
}

// Of n = 217,088 independent pixels; bounds as in the test of StructuredLight.
TEST(TimeOfFlight, NoiseHasTheStatedMeanAndDeviation) {
  const TimeOfFlight sensor({});
  for (const double z_m : {1.0, 2.5, 4.0}) {
    for (const double incidence_rad : {0.0, 30 * kRadPerDeg, 70 * kRadPerDeg}) {
      const RenderedFrame frame = turned_wall(z_m, incidence_rad, sensor.intrinsics());
      const ErrorStatistics errors = errors_about(z_m, sensor.apply(frame, 3));
      const double sigma_m = TimeOfFlight::sigma_m(z_m, incidence_rad);
      const double expected_m = std::sqrt(sigma_m * sigma_m + 1e-6 / 12);
      EXPECT_EQ(errors.count, 512 * 424);
      EXPECT_NEAR(errors.mean_m, 0.0, 5 * expected_m / std::sqrt(errors.count));
      EXPECT_NEAR(errors.deviation_m, expected_m, 0.009 * expected_m);
    }
  }
}

TEST(TimeOfFlight, PixelsFlyBetweenTheSurfacesBesideAnEdgeAndNowhereElse) {
  constexpr double kNear_m = 1.0;
  constexpr double kFar_m = 2.0;
  constexpr double kFiveSigma_m = 5 * 0.0017;  // at 2 m
  const TimeOfFlight sensor({});
  const cv::Mat_<std::uint16_t> depth_mm =
      sensor.apply(two_walls(kNear_m, kFar_m, sensor.intrinsics()), 0);
  int flying = 0;
  for (int v = 0; v < 424; ++v) {
    for (int u = 0; u < 512; ++u) {
      const double z = 1e-3 * depth_mm(v, u);
      const bool is_near = u < 256;
      if (u == 255 || u == 256) {
        EXPECT_GT(z, kNear_m - kFiveSigma_m);
        EXPECT_LT(z, kFar_m + kFiveSigma_m);
        flying += z > kNear_m + kFiveSigma_m && z < kFar_m - kFiveSigma_m ? 1 : 0;
      } else {
        EXPECT_NEAR(z, is_near ? kNear_m : kFar_m, kFiveSigma_m) << u;
      }
    }
  }
  // Half of 848, but for those that are within five deviations of a surface: 1.7 % of them.
  const double expected = 0.5 * 848 * (1 - 2 * kFiveSigma_m / (kFar_m - kNear_m));
  EXPECT_NEAR(flying, expected, 5 * std::sqrt(848 * 0.25));
}

TEST(TimeOfFlight, GrazingSurfacesAreLost) {
  const TimeOfFlight sensor({});
  for (const double incidence_deg : {79.0, 81.0}) {
    const RenderedFrame frame = turned_wall(2.0, incidence_deg * kRadPerDeg, sensor.intrinsics());
    EXPECT_EQ(invalid_share(sensor.apply(frame, 0)), incidence_deg > 80 ? 1.0 : 0.0);
  }
}

TEST(TimeOfFlight, BadConfigurationIsRefused) {
  EXPECT_THROW(TimeOfFlight({.max_incidence_rad = 1.6}), std::invalid_argument);
  EXPECT_THROW(TimeOfFlight({.edge_step_ratio = 0}), std::invalid_argument);
  EXPECT_THROW(TimeOfFlight({.flying_probability = 1.5}), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::synthetic
