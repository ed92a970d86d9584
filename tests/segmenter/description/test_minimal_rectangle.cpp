#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/description/minimal_rectangle.hpp"

namespace kintsugi::segmenter {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

// Coordinates are below 10: rounding of a few products of them.
constexpr double kRounding = 1e-12;

/// The least area of a rectangle in any direction that joins two of the points, which includes the
/// edges of the hull.
double least_area_by_trying(const Points& points) {
  double least = INFINITY;
  for (const Vector2d& p : points) {
    for (const Vector2d& q : points) {
      if (p == q) continue;
      const Vector2d axis = (q - p).normalized();
      const Vector2d across(-axis.y(), axis.x());
      Vector2d min = Vector2d::Constant(INFINITY);
      Vector2d max = Vector2d::Constant(-INFINITY);
      for (const Vector2d& r : points) {
        const Vector2d place(axis.dot(r), across.dot(r));
        min = min.cwiseMin(place);
        max = max.cwiseMax(place);
      }
      least = std::min(least, (max - min).prod());
    }
  }
  return least;
}

void expect_holds(const Rectangle& rectangle, const Points& points) {
  EXPECT_NEAR(rectangle.axis.norm(), 1.0, kRounding);
  EXPECT_GE(rectangle.size.x(), rectangle.size.y());
  const Vector2d across(-rectangle.axis.y(), rectangle.axis.x());
  for (const Vector2d& point : points) {
    const Vector2d d = point - rectangle.center;
    EXPECT_LE(std::abs(rectangle.axis.dot(d)), 0.5 * rectangle.size.x() + kRounding);
    EXPECT_LE(std::abs(across.dot(d)), 0.5 * rectangle.size.y() + kRounding);
  }
}

TEST(MinimalRectangle, IsTheLeastOfAllDirections) {
  std::mt19937 random(3);
  std::normal_distribution<double> coordinate(1.0, 2.0);
  for (int round = 0; round < 200; ++round) {
    Points points(3 + static_cast<std::size_t>(random() % 20));
    for (Vector2d& point : points) {
      point << coordinate(random), coordinate(random);
      if (round % 2 == 0) point = point.array().round();  // points on edges, and equal ones
    }
    const Rectangle rectangle = minimal_rectangle(points);
    expect_holds(rectangle, points);
    EXPECT_NEAR(rectangle.size.prod(), least_area_by_trying(points), 100 * kRounding);
  }
}

TEST(MinimalRectangle, FindsARectangleThatIsTurned) {
  for (double angle = -3.0; angle < 3.0; angle += 0.37) {
    const Vector2d axis(std::cos(angle), std::sin(angle));
    const Vector2d across(-axis.y(), axis.x());
    Points points;
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; j <= 10; ++j) {
        points.push_back(Vector2d(5.0, -1.0) + 0.1 * i * axis + 0.1 * j * across);
      }
    }
    const Rectangle rectangle = minimal_rectangle(points);
    expect_holds(rectangle, points);
    EXPECT_NEAR(rectangle.size.x(), 2.0, kRounding);
    EXPECT_NEAR(rectangle.size.y(), 1.0, kRounding);
    EXPECT_NEAR(std::abs(rectangle.axis.dot(axis)), 1.0, kRounding);
    EXPECT_NEAR((rectangle.center - Vector2d(5.0, -1.0) - axis - 0.5 * across).norm(), 0.0,
                kRounding);
  }
}

TEST(MinimalRectangle, OfALineHasNoWidth) {
  const Rectangle rectangle = minimal_rectangle({{1, 1}, {4, 5}, {2.5, 3}, {1, 1}});
  EXPECT_NEAR(rectangle.size.x(), 5.0, kRounding);
  EXPECT_NEAR(rectangle.size.y(), 0.0, kRounding);
  EXPECT_NEAR((rectangle.center - Vector2d(2.5, 3)).norm(), 0.0, kRounding);
}

TEST(MinimalRectangle, OfOnePlaceHasNoSize) {
  const Rectangle rectangle = minimal_rectangle({{3, 4}, {3, 4}});
  EXPECT_EQ(rectangle.size, Vector2d::Zero());
  EXPECT_EQ(rectangle.center, Vector2d(3, 4));
  EXPECT_EQ(rectangle.axis, Vector2d::UnitX());
}

}  // namespace
}  // namespace kintsugi::segmenter
