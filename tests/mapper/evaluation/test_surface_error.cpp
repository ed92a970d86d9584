#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/evaluation/surface_error.hpp"
#include "mapper/synthetic/rooms/scenes.hpp"

namespace kintsugi::mapper {
namespace {

/// Evenly over the sphere of radius 0.5 m, moved outwards by `error_m`, in a frame W.
std::vector<CloudPoint> sphere_points(int count, double error_m, const Pose& X_SW) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<CloudPoint> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d out_S =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const Eigen::Vector3f p = (X_SW.inverse() * ((0.5 + error_m) * out_S)).cast<float>();
    const Eigen::Vector3f n = (X_SW.linear().transpose() * out_S).cast<float>();
    points.push_back({.x = p.x(), .y = p.y(), .z = p.z(), .nx = n.x(), .ny = n.y(), .nz = n.z()});
  }
  return points;
}

Pose somewhere() {
  Pose X_SW = Pose::Identity();
  X_SW.translation() << 1.0, -2.0, 0.5;
  X_SW.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  return X_SW;
}

TEST(SurfaceError, IsTheDistanceToTheSceneFromAnyFrame) {
  const synthetic::Scene scene = synthetic::make_scene("sphere");
  constexpr int kCount = 20000;
  constexpr double kSingle_m = 1e-6;  // positions are single precision at 2 m
  for (const double error_m : {0.003, -0.003}) {
    const SurfaceError error =
        surface_error(sphere_points(kCount, error_m, somewhere()), scene, somewhere());
    EXPECT_EQ(error.num_points, kCount);
    EXPECT_NEAR(error.median_m, 0.003, kSingle_m);
    EXPECT_NEAR(error.max_m, 0.003, kSingle_m);
    EXPECT_NEAR(error.mean_m, 0.003, kSingle_m);
    // The cosine of single-precision normals is 1 to 1e-7.
    EXPECT_LT(error.percentile_95_normal_deg, 0.03);
    // 64 points in a disc of 5 cm: their number scatters by an eighth, its median hardly.
    EXPECT_NEAR(error.points_per_m2, kCount / std::numbers::pi, 0.05 * kCount / std::numbers::pi);
  }
}

TEST(SurfaceError, OrdersItsPercentiles) {
  const synthetic::Scene scene = synthetic::make_scene("sphere");
  std::vector<CloudPoint> points = sphere_points(900, 0.001, Pose::Identity());
  for (const CloudPoint& p : sphere_points(100, 0.020, Pose::Identity())) points.push_back(p);
  const SurfaceError error = surface_error(points, scene, Pose::Identity());
  EXPECT_NEAR(error.median_m, 0.001, 1e-6);
  EXPECT_NEAR(error.percentile_95_m, 0.020, 1e-6);
  EXPECT_NEAR(error.max_m, 0.020, 1e-6);
}

TEST(SurfaceError, OfNoPointsIsZero) {
  const SurfaceError error = surface_error({}, synthetic::make_scene("sphere"), Pose::Identity());
  EXPECT_EQ(error.num_points, 0);
  EXPECT_EQ(error.max_m, 0.0);
}

}  // namespace
}  // namespace kintsugi::mapper
