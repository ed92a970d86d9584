#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/preprocess/cloud_preparation.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"
#include "segmenter/preprocess/normals.hpp"

namespace kintsugi::segmenter {
namespace {

CloudPoint at(double x, double y, double z) {
  CloudPoint p;
  p.x = static_cast<float>(x);
  p.y = static_cast<float>(y);
  p.z = static_cast<float>(z);
  return p;
}

Eigen::Vector3d position(const CloudPoint& p) { return {p.x, p.y, p.z}; }
Eigen::Vector3d normal(const CloudPoint& p) { return {p.nx, p.ny, p.nz}; }

// Evenly spread (Fibonacci lattice).
std::vector<CloudPoint> sphere(int num_points, const Eigen::Vector3d& center, double radius_m) {
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<CloudPoint> points;
  for (int i = 0; i < num_points; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / num_points;
    const double r = std::sqrt(1.0 - z * z);
    const Eigen::Vector3d p =
        center + radius_m * Eigen::Vector3d(r * std::cos(golden * i), r * std::sin(golden * i), z);
    points.push_back(at(p.x(), p.y(), p.z()));
  }
  return points;
}

std::vector<CloudPoint> grid_plane(int side) {
  std::vector<CloudPoint> points;
  points.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      points.push_back(at(0.01 * column, 0.01 * row, 1.0));
    }
  }
  return points;
}

TEST(Normals, OfASphereSeenFromInsidePointToItsCentre) {
  const Eigen::Vector3d center(10.0, -20.0, 5.0);
  auto points = sphere(4000, center, 0.5);
  EXPECT_EQ(estimate_normals(points, {}), 0);
  // 21 points cover a cap of radius 0.5 * 2 sqrt(21 / 4000) = 0.07 m; its tilt against the sphere
  // is of the order of the lattice's irregularity, far below 0.1 rad.
  for (const CloudPoint& p : points) {
    const Eigen::Vector3d inwards = (center - position(p)).normalized();
    EXPECT_GT(normal(p).dot(inwards), std::cos(0.1));
    EXPECT_NEAR(normal(p).norm(), 1.0, 1e-6);
  }
}

TEST(Normals, OfAPlaneAreExactAndFaceTheViewpoint) {
  for (const double z : {0.0, 2.0}) {
    auto points = grid_plane(30);
    EXPECT_EQ(estimate_normals(points, {.viewpoint_W = Eigen::Vector3d(0.1, 0.1, z)}), 0);
    for (const CloudPoint& p : points) {
      EXPECT_NEAR(p.nz, z > 1.0 ? 1.0F : -1.0F, 1e-6F);
    }
  }
}

TEST(Normals, AgreeOverTheEdgesOfABox) {
  std::vector<CloudPoint> points;
  constexpr int kSide = 40;
  for (int a = 0; a <= kSide; ++a) {
    for (int b = 0; b <= kSide; ++b) {
      const double u = 0.01 * a;
      const double v = 0.01 * b;
      points.insert(points.end(), {at(u, v, 0), at(u, v, 0.4), at(u, 0, v), at(u, 0.4, v),
                                   at(0, u, v), at(0.4, u, v)});
    }
  }
  estimate_normals(points, {.viewpoint_W = Eigen::Vector3d(0.2, 0.2, 0.2)});
  int num_inwards = 0;
  for (const CloudPoint& p : points) {
    num_inwards += normal(p).dot(Eigen::Vector3d(0.2, 0.2, 0.2) - position(p)) > 0.0 ? 1 : 0;
  }
  EXPECT_EQ(num_inwards, static_cast<int>(points.size()));
}

TEST(Normals, OfDegenerateNeighbourhoodsAreZeroAndCounted) {
  std::vector<CloudPoint> line;
  line.reserve(100);
  for (int i = 0; i < 100; ++i) {
    line.push_back(at(0.01 * i, 0.02 * i, 3.0));
  }
  EXPECT_EQ(estimate_normals(line, {}), 100);
  EXPECT_EQ(normal(line[50]), Eigen::Vector3d::Zero());

  std::vector<CloudPoint> one_place(50, at(1, 2, 3));
  EXPECT_EQ(estimate_normals(one_place, {}), 50);

  std::vector<CloudPoint> two{at(0, 0, 0), at(1, 0, 0)};
  EXPECT_EQ(estimate_normals(two, {}), 2);

  std::vector<CloudPoint> none;
  EXPECT_EQ(estimate_normals(none, {}), 0);
}

TEST(Normals, AreTheSameInEveryRun) {
  auto points = sphere(3000, {0, 0, 0}, 1.0);
  auto again = points;
  estimate_normals(points, {});
  estimate_normals(again, {});
  EXPECT_EQ(points, again);
}

TEST(Normals, RefuseAConfigOutOfRange) {
  std::vector<CloudPoint> none;
  EXPECT_THROW(estimate_normals(none, {.num_neighbours = 2}), std::invalid_argument);
}

TEST(NearestNeighbours, EqualBruteForce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(0.0, 1.0);
  std::vector<CloudPoint> points;
  points.reserve(300);
  for (int i = 0; i < 300; ++i) {
    points.push_back(at(coordinate(random), coordinate(random), coordinate(random)));
  }
  NearestNeighbours::Result found;
  NearestNeighbours(points).find(points, 5, found);
  ASSERT_EQ(found.count, 5);
  for (std::size_t q = 0; q < points.size(); ++q) {
    std::vector<double> distances;
    distances.reserve(points.size());
    for (const CloudPoint& p : points) {
      distances.push_back((position(p) - position(points[q])).squaredNorm());
    }
    std::sort(distances.begin(), distances.end());
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_NEAR(found.squared_distances[5 * q + k], distances[k], 1e-6);  // float32 sums
    }
  }
}

TEST(MedianSpacing, IsTheStepOfAGrid) {
  // sqrt(pi 2^2 / 12.5) = 1.0027 steps.
  EXPECT_NEAR(median_spacing_m(grid_plane(40)), 0.010027F, 1e-6F);  // float32 at 1 m
}

TEST(MedianSpacing, IsZeroWhereThereIsNothingToGoBy) {
  EXPECT_EQ(median_spacing_m(std::vector<CloudPoint>(20, at(1, 1, 1))), 0.0F);
  EXPECT_EQ(median_spacing_m(grid_plane(3)), 0.0F);
  EXPECT_EQ(median_spacing_m({}), 0.0F);
}

TEST(CloudPreparation, ScalesNormalsAndLeavesHopelessOnes) {
  std::vector<CloudPoint> points(5, at(0, 0, 0));
  points[0].nz = 1.0F;
  points[1].nz = -2.0F;
  points[2].nz = 0.0F;
  points[3].nz = std::numeric_limits<float>::quiet_NaN();
  points[4].nz = 0.99995F;  // of unit length as far as four decimals tell: kept bit for bit
  EXPECT_EQ(normalize_normals(points), 1);
  EXPECT_EQ(points[1].nz, -1.0F);
  EXPECT_EQ(points[2].nz, 0.0F);
  EXPECT_EQ(points[4].nz, 0.99995F);
  const auto rejections = count_rejections(points);
  ASSERT_EQ(rejections.size(), 2U);
  EXPECT_EQ(rejections[0].reason, "its normal is not of unit length");
  EXPECT_EQ(rejections[0].first_vertex, 2);
  EXPECT_EQ(rejections[1].reason, "its normal is not finite");
  EXPECT_EQ(rejections[1].count, 1);
}

TEST(CloudPreparation, AveragesNormalsOfPointsCloserThanTheRadius) {
  auto points = grid_plane(5);  // 1 cm apart
  for (CloudPoint& p : points) p.nz = 1.0F;
  CloudPoint& tilted = points[12];  // the middle
  tilted.nx = 0.6F;
  tilted.nz = 0.8F;
  points[11].nz = -1.0F;  // faces away: the other side of a board
  points[13].nz = 0.0F;   // cannot be segmented
  average_normals(points, 0.0125F);
  // Two of four neighbours count.
  const double length = std::hypot(0.6, 2.8);
  EXPECT_NEAR(points[12].nx, 0.6 / length, 1e-7);  // float32
  EXPECT_NEAR(points[12].nz, 2.8 / length, 1e-7);
  EXPECT_EQ(points[11].nz, -1.0F);
  EXPECT_EQ(points[13].nz, 0.0F);
  EXPECT_EQ(points[0].nz, 1.0F);
  // Those below and above took in what the tilted normal was before.
  EXPECT_NEAR(points[7].nx, 0.6 / std::hypot(0.6, 4.8), 1e-7);
}

TEST(CloudPreparation, AveragingBringsNoisyNormalsNearerToTheTruth) {
  auto points = grid_plane(40);
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 0.1);
  for (CloudPoint& p : points) {
    const Eigen::Vector3f n =
        Eigen::Vector3d(noise(random), noise(random), 1.0).normalized().cast<float>();
    p.nx = n.x();
    p.ny = n.y();
    p.nz = n.z();
  }
  const auto mean_square = [&] {
    double sum = 0.0;
    for (const CloudPoint& p : points) sum += p.nx * p.nx + p.ny * p.ny;
    return sum / static_cast<double>(points.size());
  };
  const double before = mean_square();
  average_normals(points, 0.02F);
  // The mean of nine has a ninth of the variance, at the rim of four to six.
  EXPECT_LT(mean_square(), before / 7.0);
}

TEST(CloudPreparation, ComputesNormalsAroundUnusablePoints) {
  auto points = grid_plane(10);
  points.insert(points.begin() + 5, at(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  points.push_back(at(1e30, 0, 0));
  compute_normals(points, {}, {});
  EXPECT_EQ(points[5].nz, 0.0F);
  EXPECT_NEAR(std::abs(points[6].nz), 1.0F, 1e-6F);
  EXPECT_EQ(points[6].x, 0.05F);
  EXPECT_GT(usable_spacing_m(points), 0.0F);
}

}  // namespace
}  // namespace kintsugi::segmenter
