#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/synthetic/scene/shape.hpp"

namespace kintsugi::synthetic {
namespace {

using Eigen::Vector3d;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::pair<std::string, Shape>> all_shapes() {
  return {{"box", box(1.0, 0.4, 0.2)},
          {"rounded box", rounded_box(0.6, 0.4, 0.3, 0.05)},
          {"sphere", sphere(0.3)},
          {"cylinder", cylinder(0.2, 0.7)},
          {"tube", cylinder(0.25, 0.3, 0.2)},
          {"cone", cone(0.3, 0.0, 0.5)},
          {"frustum", cone(0.1, 0.25, 0.4)},
          {"capsule", capsule(0.15, 0.8)},
          {"torus", torus(0.3, 0.08)}};
}

/// Marches along a ray by the distance to the surface: slow, and shares no code with intersect().
double sphere_trace(const Shape& shape, const Vector3d& origin, const Vector3d& unit_direction) {
  double t = 0.0;
  for (int step = 0; step < 20000 && t < 10.0; ++step) {
    const double distance = signed_distance(shape, origin + t * unit_direction);
    if (distance < 1e-9) return t;
    t += distance;
  }
  return kInfinity;
}

class RandomRays {
 public:
  /// From a shell around the solid towards a point in its surroundings.
  std::pair<Vector3d, Vector3d> next() {
    const Vector3d origin = 2.0 * direction();
    const Vector3d target = 0.45 * direction();
    return {origin, (target - origin).normalized()};
  }

  Vector3d direction() {
    return Vector3d(normal_(engine_), normal_(engine_), normal_(engine_)).normalized();
  }

 private:
  std::mt19937 engine_{7};
  std::normal_distribution<double> normal_;
};

TEST(Shape, IntersectionsOfAxisRaysAreTheClosedForm) {
  const Vector3d along_x(1, 0, 0);
  const Vector3d along_z(0, 0, -1);
  const Vector3d from_left(-5, 0, 0);
  const Vector3d from_above(0, 0, 5);
  EXPECT_NEAR(intersect<double>(box(1, 2, 3), from_left, along_x), 4.5, 1e-12);
  EXPECT_NEAR(intersect<double>(sphere(0.5), from_left, along_x), 4.5, 1e-12);
  EXPECT_NEAR(intersect<double>(cylinder(0.5, 1), from_left, along_x), 4.5, 1e-12);
  EXPECT_NEAR(intersect<double>(cylinder(0.5, 1), from_above, along_z), 4.5, 1e-12);
  EXPECT_NEAR(intersect<double>(cone(1, 0.5, 1), from_left, along_x), 4.25, 1e-12);
  EXPECT_NEAR(intersect<double>(capsule(0.2, 2), from_above, along_z), 4.0, 1e-12);
  EXPECT_NEAR(intersect<double>(torus(0.5, 0.1), from_left, along_x), 4.4, 1e-9);
  EXPECT_NEAR(intersect<double>(rounded_box(1, 1, 1, 0.2), from_left, along_x), 4.5, 1e-9);
}

TEST(Shape, RayThroughABoreMeetsNothingAndOneFromWithinMeetsTheWall) {
  const Shape tube = cylinder(0.5, 1.0, 0.4);
  EXPECT_EQ(intersect<double>(tube, {0.1, 0, 5}, {0, 0, -1}), kInfinity);
  EXPECT_EQ(intersect<double>(torus(0.5, 0.1), {0.1, 0, 5}, {0, 0, -1}), kInfinity);
  EXPECT_NEAR(intersect<double>(tube, {0, 0, 0}, {1, 0, 0}), 0.4, 1e-12);
}

TEST(Shape, DirectionNeedNotBeAUnitVector) {
  for (const auto& [name, shape] : all_shapes()) {
    const Vector3d origin(-2, 0.21, 0.05);
    const Vector3d direction = Vector3d(0, 0.0, 0.02) - origin;
    const double t = intersect<double>(shape, origin, direction);
    const double scaled = intersect<double>(shape, origin, 4.0 * direction);
    if (std::isinf(t)) continue;
    EXPECT_NEAR(4.0 * scaled, t, 1e-9) << name;
  }
}

TEST(Shape, SolidThatContainsTheOriginIsNotSeen) {
  for (const auto& [name, shape] : all_shapes()) {
    if (signed_distance(shape, Vector3d::Zero()) > 0) continue;
    EXPECT_EQ(intersect<double>(shape, Vector3d::Zero(), {0.3, 0.2, 0.9}), kInfinity) << name;
  }
}

// Slow reference. Both find the first point of the surface; sphere tracing stops 1e-9 m before it,
// which along a ray that grazes at angle a is 1e-9 / sin(a): 1e-5 covers a > 1e-4.
TEST(Shape, IntersectionAgreesWithSphereTracing) {
  constexpr double kTolerance_m = 1e-5;
  RandomRays rays;
  for (const auto& [name, shape] : all_shapes()) {
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
      const auto [origin, direction] = rays.next();
      const double expected = sphere_trace(shape, origin, direction);
      const double t = intersect<double>(shape, origin, direction);
      if (std::isinf(expected) != std::isinf(t)) {  // only a ray that touches may differ
        const double touch = std::isinf(t) ? expected : t;
        EXPECT_NEAR(signed_distance(shape, origin + touch * direction), 0.0, 1e-6) << name;
        continue;
      }
      if (std::isinf(t)) continue;
      ++hits;
      EXPECT_NEAR(t, expected, kTolerance_m) << name;
    }
    EXPECT_GT(hits, 100) << name;
  }
}

// float has 24 bits: near 2 m one step is 2.4e-7 m, and a grazing ray multiplies the error.
TEST(Shape, SinglePrecisionIsWithinTensOfMicrometres) {
  constexpr double kTolerance_m = 2e-5;
  RandomRays rays;
  for (const auto& [name, shape] : all_shapes()) {
    int worse = 0;
    for (int i = 0; i < 2000; ++i) {
      const auto [origin, direction] = rays.next();
      const double expected = intersect<double>(shape, origin, direction);
      const float t =
          intersect<float>(shape.cast<float>(), origin.cast<float>(), direction.cast<float>());
      if (std::isinf(expected) != std::isinf(t)) {
        ++worse;
      } else if (std::isfinite(t) && std::abs(t - expected) > kTolerance_m) {
        const Vector3d normal = outward_normal<double>(shape, origin + expected * direction);
        if (-normal.dot(direction) > 0.05) ++worse;
      }
    }
    EXPECT_LE(worse, 10) << name;  // of 2000: rays within float's reach of an edge or outline
  }
}

TEST(Shape, NormalIsTheGradientOfTheDistance) {
  constexpr double kStep_m = 1e-6;
  RandomRays rays;
  for (const auto& [name, shape] : all_shapes()) {
    int disagreeing = 0;
    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
      const auto [origin, direction] = rays.next();
      const double t = intersect<double>(shape, origin, direction);
      if (std::isinf(t)) continue;
      ++hits;
      const Vector3d p = origin + t * direction;
      Vector3d gradient;
      for (int axis = 0; axis < 3; ++axis) {
        const Vector3d step = kStep_m * Vector3d::Unit(axis);
        gradient[axis] =
            (signed_distance(shape, p + step) - signed_distance(shape, p - step)) / (2 * kStep_m);
      }
      const Vector3d normal = outward_normal<double>(shape, p);
      EXPECT_NEAR(normal.norm(), 1.0, 1e-9) << name;
      EXPECT_LT(normal.dot(direction), 1e-6) << name;
      if ((normal - gradient).norm() > 1e-4) ++disagreeing;
    }
    EXPECT_GT(hits, 50) << name;
    EXPECT_LE(disagreeing, 1) << name;  // within a step of an edge there is no gradient
  }
}

TEST(Shape, DistanceIsThatToTheNearestOfManySurfacePoints) {
  RandomRays rays;
  for (const auto& [name, shape] : all_shapes()) {
    std::vector<Vector3d> surface;
    for (int i = 0; i < 20000; ++i) {
      const auto [origin, direction] = rays.next();
      const double t = intersect<double>(shape, origin, direction);
      if (std::isfinite(t)) surface.emplace_back(origin + t * direction);
    }
    for (int i = 0; i < 20; ++i) {
      const Vector3d p = 0.8 * rays.direction();
      double nearest = kInfinity;
      for (const Vector3d& q : surface) nearest = std::min(nearest, (p - q).norm());
      const double distance = signed_distance(shape, p);
      EXPECT_LE(std::abs(distance), nearest + 1e-9) << name;
      // Samples are about 2 cm apart, so the nearest is at most some 4 cm off to the side.
      EXPECT_GE(std::abs(distance), nearest - 0.04) << name;
    }
  }
}

TEST(Shape, BadLengthsAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(box(1, 0, 1), std::invalid_argument);
  EXPECT_THROW(box(1, nan, 1), std::invalid_argument);
  EXPECT_THROW(rounded_box(1, 1, 0.1, 0.06), std::invalid_argument);
  EXPECT_THROW(sphere(-1), std::invalid_argument);
  EXPECT_THROW(cylinder(0.1, 1, 0.1), std::invalid_argument);
  EXPECT_THROW(cone(0, 0, 1), std::invalid_argument);
  EXPECT_THROW(capsule(0.5, 0.9), std::invalid_argument);
  EXPECT_THROW(torus(0.1, 0.2), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::synthetic
