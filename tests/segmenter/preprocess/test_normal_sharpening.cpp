#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/preprocess/normal_sharpening.hpp"
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

/// Two plates, 1 cm between points, that meet along the y axis: z = 0 and x = 0, both >= 0.
std::vector<CloudPoint> corner(double noise_m) {
  constexpr int kSide = 30;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<CloudPoint> points;
  for (int a = 0; a < kSide; ++a) {
    for (int b = 0; b < kSide; ++b) {
      points.push_back(at(0.01 * a, 0.01 * b, noise_m * noise(random)));
      if (a > 0) points.push_back(at(noise_m * noise(random), 0.01 * b, 0.01 * a));
    }
  }
  return points;
}

TEST(NormalSharpening, LeavesNoNormalBetweenTwoPlates) {
  auto points = corner(0.0);
  estimate_normals(points, {.viewpoint_W = Eigen::Vector3d(1, 0.15, 1)});
  for (const CloudPoint& p : points) {
    const bool is_upright = p.x == 0.0F && p.z > 0.0F;
    const bool is_edge = p.x == 0.0F && p.z == 0.0F;
    const float expected = is_upright || (is_edge && p.nx > 0.5F) ? p.nx : p.nz;
    EXPECT_NEAR(expected, 1.0F, 1e-5F) << p.x << ' ' << p.y << ' ' << p.z;  // float32
  }
}

TEST(NormalSharpening, KeepsNormalsOnNoisyPlatesAsTheyAre) {
  // Far from the edge, with a noise of a fifth of the distance between points.
  auto points = corner(0.002);
  std::vector<LocalPlane> planes(points.size());
  NeighbourGraph graph(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Thicknesses that differ as those of 21 points do: less than by a factor of two.
    planes[i] = {.mean_W = {points[i].x, points[i].y, points[i].z},
                 .thickness_m = 0.002F * (1.0F + 0.9F * static_cast<float>(i % 7) / 7.0F),
                 .width_m = 0.012F};
    points[i].nx = static_cast<float>(i);
    const std::vector<std::uint32_t> next{static_cast<std::uint32_t>((i + 1) % points.size())};
    graph.set_neighbours(i, next);
  }
  const auto before = points;
  sharpen_normals(points, planes, graph, 4);
  EXPECT_EQ(points, before);
}

TEST(NormalSharpening, PassesAPlaneOnToThePointsThatLieOnIt) {
  // A chain of points on z = 0 whose planes lean, but for the last; and one point off that plane.
  std::vector<CloudPoint> points{at(0, 0, 0), at(0.01, 0, 0), at(0.02, 0, 0.02), at(0.03, 0, 0)};
  NeighbourGraph graph(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::vector<std::uint32_t> all{0, 1, 2, 3};
    graph.set_neighbours(i, std::span(all).first(i == 0 ? 2 : 4));
    points[i].nx = 1.0F;
  }
  points[3].nx = 0.0F;
  points[3].nz = 1.0F;
  std::vector<LocalPlane> planes(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    planes[i] = {.mean_W = {points[i].x, points[i].y, points[i].z},
                 .thickness_m = i == 3 ? 0.0F : 0.004F,
                 .width_m = 0.012F};
  }
  auto once = points;
  sharpen_normals(once, planes, graph, 1);
  EXPECT_EQ(once[0].nz, 0.0F);  // not a neighbour of the last
  EXPECT_EQ(once[1].nz, 1.0F);
  auto twice = points;
  sharpen_normals(twice, planes, graph, 2);
  EXPECT_EQ(twice[0].nz, 1.0F);
  EXPECT_EQ(twice[2].nz, 0.0F);  // off the plane
}

TEST(Normals, ThatAreMissingAreComputedAndAgreeWithTheirNeighbours) {
  std::vector<CloudPoint> points;
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 20; ++column) {
      points.push_back(at(0.01 * column, 0.01 * row, 0));
      points.back().nz = -1.0F;
    }
  }
  points[210].nz = 0.0F;
  points[211].nz = std::numeric_limits<float>::quiet_NaN();
  estimate_missing_normals(points, {});
  EXPECT_NEAR(points[210].nz, -1.0F, 1e-6F);  // float32
  EXPECT_NEAR(points[211].nz, -1.0F, 1e-6F);
  EXPECT_EQ(points[209].nz, -1.0F);
}

}  // namespace
}  // namespace kintsugi::segmenter
