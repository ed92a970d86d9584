#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "mapper/synthetic/sensors/phone_lidar.hpp"
#include "tests/mapper/synthetic/pictures.hpp"

namespace kintsugi::synthetic {
namespace {

/// Relative error of a pixel of a wall at 2 m.
double error_of(const cv::Mat_<std::uint16_t>& depth_mm, int v, int u) {
  return 1e-3 * depth_mm(v, u) / 2.0 - 1.0;
}

// Cells of 12 pixels are independent: 21 x 16 of them in each of 40 frames of other seeds, 13,440,
// and five standard errors of the deviation are 3 %.
TEST(PhoneLidar, ErrorIsOnePercentOfDepth) {
  for (const double z_m : {1.0, 2.0, 4.0}) {
    double squares = 0;
    double sum = 0;
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
      const PhoneLidar sensor({.seed = seed});
      const ErrorStatistics errors = errors_about(
          z_m, sensor.apply(flat_wall(z_m, sensor.intrinsics()), static_cast<int>(seed)));
      EXPECT_EQ(errors.count, 256 * 192);
      squares += errors.deviation_m * errors.deviation_m / 40;
      sum += errors.mean_m / 40;
    }
    EXPECT_NEAR(std::sqrt(squares), 0.01 * z_m, 0.03 * 0.01 * z_m) << z_m;
    EXPECT_NEAR(sum, 0.0, 0.05 * 0.01 * z_m) << z_m;
  }
}

TEST(PhoneLidar, ErrorsAreAlikeInACellAndChangeInHalfASecondToAPart) {
  double here = 0;
  double beside = 0;
  double cells_away = 0;
  double next_frame = 0;
  double later = 0;
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const PhoneLidar sensor({.seed = seed});
    const RenderedFrame wall = flat_wall(2.0, sensor.intrinsics());
    const cv::Mat_<std::uint16_t> now = sensor.apply(wall, 0);
    const cv::Mat_<std::uint16_t> next = sensor.apply(wall, 1);
    const cv::Mat_<std::uint16_t> half_a_second_later = sensor.apply(wall, 15);
    for (int v = 0; v < 192; ++v) {
      for (int u = 0; u + 24 < 256; ++u) {
        const double error = error_of(now, v, u);
        here += error * error;
        beside += error * error_of(now, v, u + 2);
        cells_away += error * error_of(now, v, u + 24);
        next_frame += error * error_of(next, v, u);
        later += error * error_of(half_a_second_later, v, u);
      }
    }
  }
  constexpr double kTolerance = 0.09;  // five standard errors of 3,360 cells
  EXPECT_GT(beside / here, 0.85);
  EXPECT_NEAR(cells_away / here, 0.0, kTolerance);
  EXPECT_GT(next_frame / here, 0.98);
  EXPECT_NEAR(later / here, 0.5, kTolerance);  // the share that is constant
}

TEST(PhoneLidar, EdgesAreRampsAFewPixelsWide) {
  const PhoneLidar sensor({.relative_sigma = 0});
  const cv::Mat_<std::uint16_t> depth_mm =
      sensor.apply(two_walls(1.0, 2.0, sensor.intrinsics()), 0);
  // Averaging twice over 5 pixels reaches 4 pixels: 1/z is 1 up to 123 and 1/2 from 132.
  for (int u = 0; u < 256; ++u) {
    if (u < 124) {
      EXPECT_EQ(depth_mm(90, u), 1000) << u;
    } else if (u >= 132) {
      EXPECT_EQ(depth_mm(90, u), 2000) << u;
    } else {
      EXPECT_GT(depth_mm(90, u), depth_mm(90, u - 1)) << u;
    }
  }
  EXPECT_EQ(depth_mm(90, 127), std::lround(1000 / (15.0 / 25 + 0.5 * 10 / 25)));
}

TEST(PhoneLidar, PlanesStayPlanes) {
  const PhoneLidar sensor({.relative_sigma = 0});
  RenderedFrame frame = flat_wall(1.0, sensor.intrinsics());
  const auto true_depth_m = [](int v, int u) { return 1.0 / (0.9 - 0.002 * u + 0.001 * v); };
  for (int v = 0; v < 192; ++v) {
    for (int u = 0; u < 256; ++u) frame.depth_m(v, u) = static_cast<float>(true_depth_m(v, u));
  }
  const cv::Mat_<std::uint16_t> depth_mm = sensor.apply(frame, 0);
  for (int v = 5; v < 187; ++v) {  // at the borders half of the pixels are missing
    for (int u = 5; u < 251; ++u) EXPECT_NEAR(1e-3 * depth_mm(v, u), true_depth_m(v, u), 0.00051);
  }
}

TEST(PhoneLidar, BadConfigurationIsRefused) {
  EXPECT_THROW(PhoneLidar({.relative_sigma = -1}), std::invalid_argument);
  EXPECT_THROW(PhoneLidar({.constant_share = 2}), std::invalid_argument);
  EXPECT_THROW(PhoneLidar({.cell_px = 0}), std::invalid_argument);
  EXPECT_THROW(PhoneLidar({.change_frames = 0}), std::invalid_argument);
  EXPECT_THROW(PhoneLidar({.blur_px = 4}), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::synthetic
