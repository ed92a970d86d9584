#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "mapper/core/frame/camera.hpp"
#include "mapper/core/fusion/farthest_depths.hpp"
#include "tests/mapper/core/scene_fusion.hpp"

namespace kintsugi::mapper {
namespace {

constexpr float kMaxDepth_m = 4.0F;

TEST(FarthestDepths, AreNeverLessThanADepthOntoWhichTheSphereProjects) {
  const Intrinsics intrinsics = testing::camera_of(163, 121);
  const PinholeCamera camera = pinhole_camera(intrinsics);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> depth(0.5F, 5.0F);
  cv::Mat_<float> depth_m(camera.height, camera.width);
  for (float& d : depth_m) {
    d = random() % 8 == 0 ? std::numeric_limits<float>::quiet_NaN() : depth(random);
  }
  const FarthestDepths farthest(depth_m, camera, kMaxDepth_m);
  std::normal_distribution<float> aside(0.0F, 1.0F);
  std::uniform_real_distribution<float> share(-1.0F, 1.0F);
  constexpr float kRadius_m = 0.06F;
  int num_compared = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3f center_C(aside(random), aside(random), depth(random) - 0.5F);
    const float within_m = farthest.within(center_C, kRadius_m);
    ASSERT_LE(within_m, kMaxDepth_m);
    const Eigen::Vector3f offset(share(random), share(random), share(random));
    const Eigen::Vector3f p_C = center_C + kRadius_m / std::sqrt(3.0F) * offset;
    if (p_C.z() <= 0.0F) continue;
    const float u = std::floor(p_C.x() / p_C.z() * camera.fx + camera.cx + 0.5F);
    const float v = std::floor(p_C.y() / p_C.z() * camera.fy + camera.cy + 0.5F);
    if (!(u >= 0 && u < static_cast<float>(camera.width))) continue;
    if (!(v >= 0 && v < static_cast<float>(camera.height))) continue;
    const float measured_m = depth_m(static_cast<int>(v), static_cast<int>(u));
    if (!(measured_m <= kMaxDepth_m)) continue;
    ASSERT_GE(within_m, measured_m);
    ++num_compared;
  }
  EXPECT_GT(num_compared, 1000);
}

TEST(FarthestDepths, AreZeroWhereThereIsNone) {
  const Intrinsics intrinsics = testing::camera_of(160, 120);
  cv::Mat_<float> depth_m(120, 160, std::numeric_limits<float>::quiet_NaN());
  depth_m(100, 150) = 2.0F;
  const FarthestDepths farthest(depth_m, pinhole_camera(intrinsics), kMaxDepth_m);
  EXPECT_EQ(farthest.within({0.0F, 0.0F, 2.0F}, 0.05F), 0.0F);
  EXPECT_EQ(farthest.within({0.0F, 0.0F, 0.05F}, 0.05F), 2.0F) << "it surrounds the camera";
}

}  // namespace
}  // namespace kintsugi::mapper
