#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "mapper/core/frame/kernel_arguments.hpp"
#include "mapper/core/frame/surface_pyramid.hpp"
#include "mapper/core/kernels/instruction_set.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "tests/mapper/core/box_room.hpp"

namespace kintsugi::mapper {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kReach = kSmoothingReach_px;

cv::Mat_<float> padded(const cv::Mat_<float>& depth_m) {
  cv::Mat_<float> result;
  cv::copyMakeBorder(depth_m, result, kReach, kReach, kReach, kReach, cv::BORDER_CONSTANT,
                     cv::Scalar(kNaN));
  return result;
}

cv::Mat_<float> smooth(const cv::Mat_<float>& depth_m, const DepthTolerance& tolerance,
                       const Kernels& kernels) {
  const cv::Mat_<float> source = padded(depth_m);
  cv::Mat_<float> result(depth_m.size());
  for (int v = 0; v < depth_m.rows; ++v) {
    kernels.smooth_depth_row(source[0], depth_m.cols, v, tolerance, result[v]);
  }
  return result;
}

/// The same from the description, in double.
cv::Mat_<float> slowly_smooth(const cv::Mat_<float>& depth_m, const DepthNoise& noise,
                              const Intrinsics& camera) {
  cv::Mat_<float> result(depth_m.size());
  for (int v = 0; v < depth_m.rows; ++v) {
    for (int u = 0; u < depth_m.cols; ++u) {
      const double here_m = depth_m(v, u);
      const double allowed_m =
          4.0 * std::numbers::sqrt2 * noise.sigma_m(here_m) + 4.0 * kReach * here_m / camera.fx;
      double sum_m = 0.0;
      int number = 0;
      for (int dv = -kReach; dv <= kReach; ++dv) {
        for (int du = -kReach; du <= kReach; ++du) {
          if (v + dv < 0 || u + du < 0 || v + dv >= depth_m.rows || u + du >= depth_m.cols) {
            continue;
          }
          const double depth = depth_m(v + dv, u + du);
          if (!(std::abs(depth - here_m) < allowed_m)) continue;
          sum_m += depth;
          ++number;
        }
      }
      result(v, u) = number > 0 ? static_cast<float>(sum_m / number) : kNaN;
    }
  }
  return result;
}

/// A near and a far surface with noise, and invalid pixels at borders and inside.
cv::Mat_<float> noisy_picture(int width, int height) {
  cv::Mat_<float> depth_m(height, width);
  cv::RNG random(9);
  random.fill(depth_m, cv::RNG::NORMAL, 0.0, 0.002);
  const int step = width / 3;
  depth_m.colRange(0, step) += 1.0F;
  depth_m.colRange(step, width) += 2.0F;
  depth_m(0, 0) = kNaN;
  depth_m(height / 2, width - 1) = kNaN;
  depth_m(cv::Rect(width / 2, height / 3, std::min(width / 2, 7), 3)).setTo(kNaN);
  return depth_m;
}

class SmoothDepthRow : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Widths, SmoothDepthRow, ::testing::Values(3, 15, 16, 17, 32, 203));

TEST_P(SmoothDepthRow, GivesTheMeansOfASlowReference) {
  const Intrinsics camera = testing::test_camera();
  const DepthNoise noise;
  const cv::Mat_<float> depth_m = noisy_picture(GetParam(), 12);
  const cv::Mat_<float> fast = smooth(depth_m, depth_tolerance(noise, camera), best_kernels());
  const cv::Mat_<float> slow = slowly_smooth(depth_m, noise, camera);
  for (int v = 0; v < depth_m.rows; ++v) {
    for (int u = 0; u < depth_m.cols; ++u) {
      ASSERT_EQ(std::isnan(fast(v, u)), std::isnan(slow(v, u))) << v << ' ' << u;
      if (!std::isnan(slow(v, u))) {
        EXPECT_NEAR(fast(v, u), slow(v, u), 2e-6) << v << ' ' << u;
      }
    }
  }
}

TEST_P(SmoothDepthRow, GivesTheSameBytesWithEveryInstructionSet) {
  const DepthTolerance tolerance = depth_tolerance(DepthNoise(), testing::test_camera());
  const cv::Mat_<float> depth_m = noisy_picture(GetParam(), 12);
  const cv::Mat_<float> portable =
      smooth(depth_m, tolerance, kernels_for(InstructionSet::kPortable));
  for (const InstructionSet set : kInstructionSets) {
    if (!is_supported(set)) continue;
    const cv::Mat_<float> same = smooth(depth_m, tolerance, kernels_for(set));
    EXPECT_EQ(std::memcmp(same.data, portable.data, portable.total() * sizeof(float)), 0)
        << name_of(set);
  }
}

TEST(SmoothDepth, LeavesThePixelsBesideTheRowAlone) {
  const DepthTolerance tolerance = depth_tolerance(DepthNoise(), testing::test_camera());
  const cv::Mat_<float> source = padded(cv::Mat_<float>(3, 17, 1.0F));
  cv::Mat_<float> result(1, 32, 7.0F);
  best_kernels().smooth_depth_row(source[0], 17, 1, tolerance, result[0]);
  for (int u = 0; u < 17; ++u) EXPECT_FLOAT_EQ(result(0, u), 1.0F);
  for (int u = 17; u < 32; ++u) EXPECT_EQ(result(0, u), 7.0F);
}

/// Root mean square of the angle between the normals of a wall and its true normal, radians.
double normal_error_rad(const SurfaceMap& surface) {
  double squares = 0.0;
  int number = 0;
  for (int v = 3; v + 3 < surface.depth_m.rows; ++v) {
    for (int u = 3; u + 3 < surface.depth_m.cols; ++u) {
      if (std::isnan(surface.normal_z(v, u))) continue;
      const double angle_rad =
          std::acos(std::min(1.0F, surface.normal(v, u).dot(Eigen::Vector3f(0, 0, -1))));
      squares += angle_rad * angle_rad;
      ++number;
    }
  }
  return std::sqrt(squares / number);
}

TEST(PyramidFromDepth, HasSmoothNormalsOnTheTwoFinestLevelsAndUnchangedDepths) {
  const Intrinsics camera = testing::test_camera(160, 120);
  cv::Mat_<float> depth_m(camera.height, camera.width);
  cv::RNG random(2);
  random.fill(depth_m, cv::RNG::NORMAL, 3.0, DepthNoise().sigma_m(3.0));
  const SurfacePyramid pyramid = pyramid_from_depth(depth_m, camera, 0, 3, 10.0F);
  EXPECT_EQ(cv::norm(pyramid[0].depth_m, depth_m, cv::NORM_INF), 0.0);
  for (const std::size_t level : {0, 1, 2}) {
    const SurfaceMap& smooth = pyramid[level];
    const SurfaceMap raw = surface_from_depth(smooth.depth_m, smooth.intrinsics);
    if (level < 2) {
      // Means of 25 depths, at pixels two apart that share 15 of these.
      EXPECT_LT(normal_error_rad(smooth), 0.5 * normal_error_rad(raw)) << level;
    } else {
      EXPECT_EQ(normal_error_rad(smooth), normal_error_rad(raw));
    }
  }
}

TEST(PyramidFromDepth, KeepsTheNoiseOfTheSensor) {
  const SensorNoise noise{.depth = {.base_m = 0.01, .share = 0.02, .growth_per_m = 0.03},
                          .local = {.base_m = 0.04, .share = 0.05, .growth_per_m = 0.06}};
  const Intrinsics camera = testing::test_camera(64, 48);
  const SurfacePyramid measured =
      pyramid_from_depth(cv::Mat_<float>(48, 64, 1.0F), camera, 1, 2, 10.0F, noise);
  for (const SurfaceMap& level : measured) {
    EXPECT_EQ(level.noise.sigma_m(2.0), noise.depth.sigma_m(2.0));
    EXPECT_EQ(level.local_noise.sigma_m(2.0), noise.local.sigma_m(2.0));
  }
  const SurfaceMap half = pyramid_from_surface(measured.front(), 2).back();
  EXPECT_EQ(half.noise.sigma_m(2.0), noise.depth.sigma_m(2.0));
  EXPECT_EQ(half.local_noise.sigma_m(2.0), noise.local.sigma_m(2.0));
}

}  // namespace
}  // namespace kintsugi::mapper
