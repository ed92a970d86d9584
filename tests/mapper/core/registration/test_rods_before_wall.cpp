// Registration by outlines where the surfaces leave directions open.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "mapper/core/registration/registration.hpp"
#include "tests/mapper/core/boxes_before_wall.hpp"

namespace kintsugi::mapper {
namespace {

using Eigen::Vector3d;
using testing::angle_rad;
using testing::Box;
using testing::distance_m;

Vector6d twist(double x, double y, double z, double a, double b, double c) {
  Vector6d xi;
  xi << x, y, z, a, b, c;
  return xi;
}

constexpr double kWall_m = 2.5;
constexpr double kHalfWidth_m = 0.02;

/// A rod 1.5 m ahead, along x or y.
Box rod(int axis, double half_length_m) {
  Vector3d half = Vector3d::Constant(kHalfWidth_m);
  half[axis] = half_length_m;
  const Vector3d centre_W(0.0, 0.0, 1.5);
  return {centre_W - half, centre_W + half};
}

SurfaceMap render(const std::vector<Box>& rods, const Pose& X_WC) {
  return testing::render_before_wall(rods, kWall_m, X_WC);
}

/// Turned about the view, so that the rods cross pixels in all places.
const Pose kX_WV = se3_retract(twist(0, 0, 0, 0, 0, 0.3));

/// From X_WV, by depth alone.
Registration registered(const std::vector<Box>& rods, const Pose& X_WC) {
  const Model model{pyramid_from_surface(render(rods, kX_WV), 3), kX_WV};
  const TrackingInput frame{
      0, pyramid_from_depth(render(rods, X_WC).depth_m, testing::test_camera(), 0, 3, 10.0F), {}};
  return register_frame(frame, model, {}, kX_WV, {});
}

std::vector<Vector6d> motions() {
  return {twist(0.015, -0.01, 0.01, 0, 0, 0), twist(0, 0, 0, 0.01, -0.01, 0.02),
          twist(-0.01, 0.015, -0.01, 0.01, 0.005, -0.015)};
}

// A pixel is 5.5 mm wide on the rods. Outlines are known to half a pixel, and they cross the pixels
// of hundreds of lines in all places.
constexpr double kAligned_m = 0.002;
constexpr double kAligned_rad = 0.002;

TEST(RodsBeforeWall, DetermineTheWholePoseIfTheyCross) {
  const std::vector<Box> cross = {rod(0, 0.5), rod(1, 0.5)};
  for (const Vector6d& motion : motions()) {
    const Pose X_WC = kX_WV * se3_retract(motion);
    const Registration result = registered(cross, X_WC);
    EXPECT_TRUE(result.quality.solved);
    EXPECT_EQ(result.open_to_depth_C.cols(), 3) << "depth alone knows neither x nor y nor roll";
    EXPECT_EQ(result.quality.undetermined, 0);
    EXPECT_LT(distance_m(result.X_WC, X_WC), kAligned_m) << motion.transpose();
    EXPECT_LT(angle_rad(result.X_WC, X_WC), kAligned_rad) << motion.transpose();
  }
}

TEST(RodsBeforeWall, LeaveTheMotionAlongAnEndlessRodOpen) {
  const std::vector<Box> endless = {rod(1, 10.0)};
  for (const Vector6d& motion : motions()) {
    const Pose X_WC = kX_WV * se3_retract(motion);
    const Registration result = registered(endless, X_WC);
    ASSERT_EQ(result.quality.undetermined, 1);
    const Vector3d along_W = (result.X_WC.linear() * result.undetermined_C.col(0).head<3>());
    EXPECT_GT(std::abs(along_W.normalized().y()), 0.99);
    const Vector3d error_W = result.X_WC.translation() - X_WC.translation();
    EXPECT_LT(std::hypot(error_W.x(), error_W.z()), kAligned_m) << motion.transpose();
    EXPECT_LT(angle_rad(result.X_WC, X_WC), kAligned_rad) << motion.transpose();
  }
}

TEST(RodsBeforeWall, GiveTheSamePoseWhateverTheThreads) {
  const std::vector<Box> cross = {rod(0, 0.5), rod(1, 0.5)};
  const Pose X_WC = kX_WV * se3_retract(motions().back());
  const auto with_threads = [&](int threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return registered(cross, X_WC).X_WC;
  };
  EXPECT_EQ(with_threads(1).matrix(), with_threads(4).matrix());
}

}  // namespace
}  // namespace kintsugi::mapper
