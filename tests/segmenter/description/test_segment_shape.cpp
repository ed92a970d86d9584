// The box and the plane of points, against shapes that are known.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/description/segment_shape.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using Eigen::Vector3d;
using testing::make_point;

constexpr float kResolution_m = 0.01F;
// Points are float32 of coordinates up to 4 m: each is off by up to 2.4e-7 m.
constexpr double kFloat_m = 1e-6;
// Heights are summed in units of 60 nm.
constexpr double kUnit_m = 6e-8;
// What that turns an axis by, of a shape of 0.1 m and more.
constexpr double kFloat_rad = 1e-5;

/// Where shapes of these tests stand.
Pose oblique_pose() {
  Pose X_WB = Pose::Identity();
  X_WB.translate(Vector3d(1.0, -2.0, 3.0));
  X_WB.rotate(Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, -0.5).normalized()));
  return X_WB;
}

CloudPoint point_at(const Pose& X_WB, const Vector3d& p_B, const Vector3d& normal_B) {
  const Vector3d p_W = X_WB * p_B;
  const Vector3d normal_W = X_WB.linear() * normal_B;
  return make_point(p_W.x(), p_W.y(), p_W.z(), normal_W.x(), normal_W.y(), normal_W.z());
}

/// A lattice of 1 cm on the plate `size_m` around the origin of B, heights by `height_m`.
template <class Height>
std::vector<CloudPoint> plate(double length_m, double width_m, const Height& height_m) {
  std::vector<CloudPoint> points;
  const auto num_x = std::lround(length_m / 0.01);
  const auto num_y = std::lround(width_m / 0.01);
  for (long i = 0; i <= num_x; ++i) {
    for (long j = 0; j <= num_y; ++j) {
      const double x = 0.01 * static_cast<double>(i) - 0.5 * length_m;
      const double y = 0.01 * static_cast<double>(j) - 0.5 * width_m;
      points.push_back(point_at(oblique_pose(), {x, y, height_m(x, y)}, Vector3d::UnitZ()));
    }
  }
  return points;
}

void expect_holds(const OrientedBox& box, const std::vector<CloudPoint>& points_W) {
  EXPECT_NEAR((box.X_WB.linear() * box.X_WB.linear().transpose() - Eigen::Matrix3d::Identity())
                  .cwiseAbs()
                  .maxCoeff(),
              0.0, 1e-12);
  EXPECT_NEAR(box.X_WB.linear().determinant(), 1.0, 1e-12);
  EXPECT_GE(box.size_m.x(), box.size_m.y());
  Vector3d reach_m = Vector3d::Zero();
  for (const CloudPoint& p : points_W) {
    const Vector3d p_B = box.X_WB.inverse() * Vector3d(p.x, p.y, p.z);
    reach_m = reach_m.cwiseMax(p_B.cwiseAbs());
  }
  // It holds them, and no smaller one does.
  EXPECT_NEAR((2.0 * reach_m - box.size_m).cwiseAbs().maxCoeff(), 0.0, 1e-9);
}

TEST(SegmentShape, PlateIsPlanar) {
  const auto points = plate(0.8, 0.5, [](double, double) { return 0.0; });
  const SegmentShape shape = shape_of(points, kResolution_m);
  const Pose X_WB = oblique_pose();
  EXPECT_TRUE(shape.is_planar);
  EXPECT_NEAR((shape.plane.normal_W - X_WB.linear().col(2)).norm(), 0.0, kFloat_rad);
  EXPECT_NEAR(shape.plane.offset_m, shape.plane.normal_W.dot(X_WB.translation()), kFloat_m);
  EXPECT_LT(shape.plane.rms_m, kFloat_m);
  EXPECT_EQ(shape.plane.inlier_share, 1.0);
  expect_holds(shape.box, points);
  EXPECT_NEAR((shape.box.X_WB.translation() - X_WB.translation()).norm(), 0.0, kFloat_m);
  EXPECT_NEAR((shape.box.size_m - Vector3d(0.8, 0.5, 0.0)).norm(), 0.0, 4 * kFloat_m);
  EXPECT_EQ(shape.box.X_WB.linear().col(2), shape.plane.normal_W);
  EXPECT_NEAR(std::abs(shape.box.X_WB.linear().col(0).dot(X_WB.linear().col(0))), 1.0, kFloat_rad);
}

TEST(SegmentShape, NormalFacesFreeSpace) {
  auto points = plate(0.3, 0.2, [](double, double) { return 0.0; });
  const Vector3d front = shape_of(points, kResolution_m).plane.normal_W;
  for (CloudPoint& p : points) {
    p.nx = -p.nx;
    p.ny = -p.ny;
    p.nz = -p.nz;
  }
  const Vector3d back = shape_of(points, kResolution_m).plane.normal_W;
  EXPECT_EQ(back, -front);
  for (std::size_t i = 0; i < points.size(); i += 2) {  // a thin sheet seen from both sides
    points[i].nx = -points[i].nx;
    points[i].ny = -points[i].ny;
    points[i].nz = -points[i].nz;
  }
  points.erase(points.begin());  // 651 points: now as many face up as down
  const Vector3d either = shape_of(points, kResolution_m).plane.normal_W;
  EXPECT_GT(either.x(), 0.0);
}

TEST(SegmentShape, RmsAndShareAreThoseOfTheHeights) {
  // Every tenth row is raised by 3 cm: the plane rises by 3 mm, and these rows are 27 mm above it.
  int row = -1;
  double last_x = INFINITY;
  const auto points = plate(0.99, 0.5, [&](double x, double) {
    if (x != last_x) ++row;
    last_x = x;
    return row % 10 == 4 || row % 10 == 5 ? 0.03 * (row % 2 == 0 ? 1 : -1) : 0.0;
  });
  const SegmentShape shape = shape_of(points, kResolution_m);
  // Up and down by turns: the mean height is 0; the moments that turn the plane are small.
  EXPECT_NEAR(shape.plane.inlier_share, 0.8, 1e-12);
  EXPECT_NEAR(shape.plane.rms_m, 0.03 * std::sqrt(0.2), 1e-5);
  EXPECT_FALSE(shape.is_planar);
}

TEST(SegmentShape, PlaneIsTheOneOfLeastSquares) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0.0, 0.004);
  const auto points = plate(0.4, 0.3, [&](double, double) { return noise(random); });
  const PlaneFit best = shape_of(points, kResolution_m).plane;
  const auto rms_of = [&](const Vector3d& normal_W, double offset_m) {
    double sum = 0.0;
    for (const CloudPoint& p : points) {
      const double height_m = normal_W.dot(Vector3d(p.x, p.y, p.z)) - offset_m;
      sum += height_m * height_m;
    }
    return std::sqrt(sum / static_cast<double>(points.size()));
  };
  EXPECT_NEAR(rms_of(best.normal_W, best.offset_m), best.rms_m, kUnit_m);
  std::uniform_real_distribution<double> turn(-0.02, 0.02);
  for (int k = 0; k < 100; ++k) {
    const Vector3d other =
        (best.normal_W + Vector3d(turn(random), turn(random), turn(random))).normalized();
    const Vector3d foot_W = best.offset_m * best.normal_W;
    EXPECT_GT(rms_of(other, other.dot(foot_W)), best.rms_m);
    EXPECT_GT(rms_of(best.normal_W, best.offset_m + turn(random)), best.rms_m);
  }
}

TEST(SegmentShape, DoesNotDependOnTheOrderOfPoints) {
  std::mt19937 random(8);
  std::normal_distribution<double> noise(0.0, 0.004);
  auto points = plate(0.4, 0.3, [&](double, double) { return noise(random); });
  const SegmentShape shape = shape_of(points, kResolution_m);
  for (int k = 0; k < 5; ++k) {
    std::shuffle(points.begin(), points.end(), random);
    const SegmentShape other = shape_of(points, kResolution_m);
    EXPECT_EQ(other.box.X_WB.matrix(), shape.box.X_WB.matrix());
    EXPECT_EQ(other.box.size_m, shape.box.size_m);
    EXPECT_EQ(other.plane.normal_W, shape.plane.normal_W);
    EXPECT_EQ(other.plane.offset_m, shape.plane.offset_m);
    EXPECT_EQ(other.plane.rms_m, shape.plane.rms_m);
    EXPECT_EQ(other.plane.inlier_share, shape.plane.inlier_share);
  }
}

TEST(SegmentShape, BallIsNotPlanar) {
  std::mt19937 random(5);
  std::normal_distribution<double> unit;
  std::vector<CloudPoint> points;
  for (int k = 0; k < 500; ++k) {
    const Vector3d n = Vector3d(unit(random), unit(random), unit(random)).normalized();
    points.push_back(point_at(oblique_pose(), 0.06 * n, n));
  }
  const SegmentShape shape = shape_of(points, kResolution_m);
  EXPECT_FALSE(shape.is_planar);
  expect_holds(shape.box, points);
  EXPECT_NEAR((shape.box.size_m - Vector3d::Constant(0.12)).cwiseAbs().maxCoeff(), 0.0, 0.005);
}

TEST(SegmentShape, PencilIsNoPlane) {
  const auto points = plate(0.18, 0.03, [](double, double) { return 0.0; });
  const SegmentShape shape = shape_of(points, kResolution_m);
  EXPECT_EQ(shape.plane.inlier_share, 1.0);
  EXPECT_FALSE(shape.is_planar);
  EXPECT_TRUE(shape_of(points, 0.005F).is_planar);  // 6 voxels wide then
}

TEST(SegmentShape, LinesAndSinglePointsHaveABoxAllTheSame) {
  std::vector<CloudPoint> points;
  for (int i = 0; i <= 30; ++i) {
    points.push_back(point_at(oblique_pose(), {0.01 * i, 0.0, 0.0}, Vector3d::UnitZ()));
  }
  const SegmentShape line = shape_of(points, kResolution_m);
  EXPECT_FALSE(line.is_planar);
  expect_holds(line.box, points);
  EXPECT_NEAR((line.box.size_m - Vector3d(0.3, 0.0, 0.0)).norm(), 0.0, 4 * kFloat_m);
  EXPECT_NEAR(line.plane.normal_W.dot(oblique_pose().linear().col(0)), 0.0, kFloat_rad);

  points.resize(1);
  const SegmentShape single = shape_of(points, kResolution_m);
  EXPECT_FALSE(single.is_planar);
  expect_holds(single.box, points);
  EXPECT_EQ(single.box.size_m, Vector3d::Zero());
  EXPECT_EQ(single.plane.rms_m, 0.0);
}

TEST(SegmentShape, FarFromTheOriginItIsTheSame) {
  // At 1 km float32 steps are 61 um.
  std::vector<CloudPoint> points = plate(0.8, 0.5, [](double, double) { return 0.0; });
  for (CloudPoint& p : points) p.x += 1000.0F;
  const SegmentShape shape = shape_of(points, kResolution_m);
  EXPECT_TRUE(shape.is_planar);
  EXPECT_NEAR((shape.box.size_m - Vector3d(0.8, 0.5, 0.0)).cwiseAbs().maxCoeff(), 0.0, 2e-4);
}

}  // namespace
}  // namespace kintsugi::segmenter
