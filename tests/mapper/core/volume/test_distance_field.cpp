// What fusion leaves in the voxels, against closed forms.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/mapper/core/exact_volume.hpp"
#include "tests/mapper/core/scene_fusion.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kResolution_m = 0.01;
constexpr double kRounding = 1.5 / kDistanceScale;  // to 16 bit, at each of two fusions

/// Calls check(centre in W, distance as a fraction of the truncation) for each observed voxel.
template <typename Check>
int for_each_observed(const TsdfVolume& volume, Check check) {
  int count = 0;
  for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) {
    if (!volume.in_use(slot)) continue;
    for (int i = 0; i < kBlockVoxels; ++i) {
      const Voxel voxel = volume.voxels(slot).voxels[i];
      if (voxel_weight(voxel) == 0) continue;
      check(testing::voxel_center_W(volume, volume.coord(slot), testing::voxel_of_index(i)),
            static_cast<double>(voxel_distance(voxel)));
      ++count;
    }
  }
  return count;
}

TEST(DistanceField, OfAPlaneSeenStraightOnIsTheHeightAboveIt) {
  constexpr double kHeight_m = 0.9;
  testing::View view;
  view.frame.intrinsics = testing::small_camera();
  view.frame.depth_m = cv::Mat_<float>(240, 320, static_cast<float>(kHeight_m));
  view.X_WC.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();  // looks down
  view.X_WC.translation() << 0.0, 0.0, kHeight_m;
  TsdfVolume volume(
      {.region = RegionShape::kCube, .volume_size_m = 3.0, .resolution_m = kResolution_m});
  testing::fuse({view, view}, volume);
  // Depth and positions are single precision at 1 m.
  constexpr double kSingle = 3e-7 / (4 * kResolution_m);
  const int count = for_each_observed(volume, [&](const Eigen::Vector3d& p_W, double fraction) {
    const double expected = std::min(p_W.z() / volume.truncation_m(), 1.0);
    ASSERT_NEAR(fraction, expected, kRounding + kSingle);
    ASSERT_GE(p_W.z(), -volume.truncation_m() - 1e-6);
  });
  EXPECT_GT(count, 100'000);
}

TEST(DistanceField, OfASphereIsThatAlongTheDepthAxis) {
  constexpr double kRadius_m = 0.5;
  constexpr double kDistance_m = 1.5;
  const auto scene = synthetic::make_scene("sphere");
  const testing::View view =
      testing::make_view(scene, synthetic::look_at({kDistance_m, 0.0, 0.0}, {0.0, 0.0, 0.0}));
  TsdfVolume volume(
      {.region = RegionShape::kCube, .volume_size_m = 1.6, .resolution_m = kResolution_m});
  testing::fuse({view, view}, volume);
  const Pose X_CW = view.X_WC.inverse();
  const Eigen::Vector3d center_C = X_CW.translation();
  int compared = 0;
  for_each_observed(volume, [&](const Eigen::Vector3d& p_W, double fraction) {
    const Eigen::Vector3d p_C = X_CW * p_W;
    const Eigen::Vector3d ray_C = p_C / p_C.z();
    // Where the ray (depth z along it) meets the sphere: |z ray - center|^2 = R^2.
    const double a = ray_C.squaredNorm();
    const double b = ray_C.dot(center_C);
    const double discriminant = b * b - a * (center_C.squaredNorm() - kRadius_m * kRadius_m);
    if (discriminant < 0.0) return;
    const double depth_m = (b - std::sqrt(discriminant)) / a;
    const Eigen::Vector3d normal_C = (depth_m * ray_C - center_C).normalized();
    const double cosine = -normal_C.dot(ray_C.normalized());
    if (cosine < std::cos(M_PI / 4)) return;
    // The voxel takes the nearest pixel's depth: up to 0.71 pixels aside, where the sphere's depth
    // changes by the tangent of the angle at which it is seen, and half a bit of the curvature.
    const double pixel_m = depth_m / view.frame.intrinsics.fx;
    const double aside_m = 0.71 * pixel_m * (std::tan(std::acos(cosine)) + 0.1);
    const double expected = (depth_m - p_C.z()) / volume.truncation_m();
    ASSERT_NEAR(fraction, std::min(expected, 1.0), aside_m / volume.truncation_m() + kRounding);
    ++compared;
  });
  EXPECT_GT(compared, 20'000);
}

}  // namespace
}  // namespace kintsugi::mapper
