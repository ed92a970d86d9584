// A wall that was seen from one side, from afar, does not move its other side.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/core/extraction/surface_extractor.hpp"
#include "mapper/core/frame/depth_noise.hpp"
#include "mapper/core/fusion/truncation.hpp"
#include "tests/mapper/core/scene_fusion.hpp"

namespace kintsugi::mapper {
namespace {

constexpr double kFarSide_m = 4.0;
constexpr double kThickness_m = 0.06;
constexpr double kOtherSide_m = kFarSide_m + kThickness_m;
constexpr double kNear_m = 0.8;

void fuse(const Integrator& integrator, TsdfVolume& volume, double depth_m, const Pose& X_WC,
          int num_frames) {
  RgbdFrame frame;
  frame.intrinsics = testing::camera_of(160, 120);
  frame.depth_m =
      cv::Mat_<float>(frame.intrinsics.height, frame.intrinsics.width, static_cast<float>(depth_m));
  for (int i = 0; i < num_frames; ++i) integrator.integrate(frame, X_WC, volume, DepthNoise());
}

TEST(ThinWall, StaysWhereItIsOnTheSideThatIsSeenLater) {
  TsdfVolume volume({.max_range_m = 6.0});
  const Integrator integrator({.max_depth_m = 6.0});
  ASSERT_GT(kTruncationSigmas * DepthNoise().sigma_m(kFarSide_m), kThickness_m)
      << "what is seen from afar reaches through the wall";
  ASSERT_LT(volume.truncation_m(), kThickness_m);
  fuse(integrator, volume, kFarSide_m, Pose::Identity(), 60);
  Pose X_WC = Pose::Identity();  // on the other side, looking back
  X_WC.translation().z() = kOtherSide_m + kNear_m;
  X_WC.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  fuse(integrator, volume, kNear_m, X_WC, 20);

  int num_points = 0;
  for (const CloudPoint& p : SurfaceExtractor({}).extract(volume.snapshot())) {
    if (p.nz < 0.5F) continue;  // of the far side
    ++num_points;
    // Distances have steps of 4 micrometres, and are averaged in whole ones.
    EXPECT_NEAR(p.z, kOtherSide_m, 1e-4) << p.x << ' ' << p.y;
  }
  EXPECT_GT(num_points, 1000);
}

}  // namespace
}  // namespace kintsugi::mapper
