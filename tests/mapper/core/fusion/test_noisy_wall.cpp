// A wall whose depth is noisy is fused into one surface.

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/core/extraction/surface_extractor.hpp"
#include "mapper/core/frame/depth_noise.hpp"
#include "tests/mapper/core/scene_fusion.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kResolution_m = 4.5 / 512;
constexpr double kWall_m = 5.0;
constexpr int kNumFrames = 60;

struct WallShape {
  double mean_m = 0.0;       ///< behind the true wall
  double deviation_m = 0.0;  ///< of the points from the true wall
  double stray_share = 0.0;  ///< of the points, farther from it than four deviations of the mean of
                             ///< all frames
  double points_per_voxel = 0.0;  ///< of the wall's area
};

/// Frames of a wall across the view of a camera at rest, each pixel with noise of its own.
WallShape fuse_wall(double max_truncation_vox) {
  const DepthNoise noise;
  TsdfVolume volume({.max_range_m = 7.0,
                     .resolution_m = kResolution_m,
                     .max_truncation_vox = max_truncation_vox});
  const Integrator integrator({.max_depth_m = 7.0});
  std::mt19937 random(11);
  std::normal_distribution<float> error_m(0.0F, static_cast<float>(noise.sigma_m(kWall_m)));
  RgbdFrame frame;
  frame.intrinsics = testing::camera_of(160, 120);
  for (int i = 0; i < kNumFrames; ++i) {
    frame.depth_m = cv::Mat_<float>(frame.intrinsics.height, frame.intrinsics.width);
    for (float& depth_m : frame.depth_m) {
      depth_m = static_cast<float>(kWall_m) + error_m(random);
    }
    integrator.integrate(frame, Pose::Identity(), volume, noise);
  }
  const std::vector<CloudPoint> points =
      SurfaceExtractor({.weight_threshold = 8}).extract(volume.snapshot());
  const double sigma_of_mean_m = noise.sigma_m(kWall_m) / std::sqrt(kNumFrames);
  WallShape shape;
  double squares_m2 = 0.0;
  for (const CloudPoint& p : points) {
    const double behind_m = p.z - kWall_m;
    shape.mean_m += behind_m;
    squares_m2 += behind_m * behind_m;
    if (std::abs(behind_m) > 4 * sigma_of_mean_m) shape.stray_share += 1.0;
  }
  const auto count = static_cast<double>(points.size());
  shape.mean_m /= count;
  shape.deviation_m = std::sqrt(squares_m2 / count);
  shape.stray_share /= count;
  const double pixel_m = kWall_m / frame.intrinsics.fx;
  const double pixels = static_cast<double>(frame.depth_m.total());
  shape.points_per_voxel = count / (pixels * pixel_m * pixel_m / (kResolution_m * kResolution_m));
  return shape;
}

TEST(NoisyWall, IsOneSurfaceWhereTheTruncationGrowsWithTheNoise) {
  const double sigma_of_mean_m = DepthNoise().sigma_m(kWall_m) / std::sqrt(kNumFrames);
  const WallShape wall = fuse_wall(16.0);
  EXPECT_NEAR(wall.mean_m, 0.0, 0.2 * sigma_of_mean_m);
  EXPECT_LT(wall.deviation_m, 1.5 * sigma_of_mean_m);
  EXPECT_LT(wall.stray_share, 0.01);
  EXPECT_GT(wall.points_per_voxel, 0.8);
}

TEST(NoisyWall, FraysAtOneTruncationOfFourVoxels) {
  const WallShape wall = fuse_wall(4.0);
  EXPECT_GT(wall.stray_share, 0.1);
}

}  // namespace
}  // namespace kintsugi::mapper
