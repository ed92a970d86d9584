#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "segmenter/core/graph/edge_weight.hpp"
#include "tests/segmenter/core/random_clouds.hpp"

namespace kintsugi::segmenter {
namespace {

using testing::make_point;

constexpr EdgeWeight with_lambda(double lambda) { return {.color_weight = lambda}; }
constexpr EdgeWeight kNormalsOnly = with_lambda(0.0);

// Two faces that meet at the y axis with normals 60 degrees apart: 1 - n_i . n_j = 1/2 up to the
// rounding of the normals to float32 (2^-24 each) and of the weight.
constexpr float kRounding = 4e-7F;
const double kTilt = std::acos(-1.0) / 6.0;
const CloudPoint kLeft = make_point(-0.01, 0, 0, -std::sin(kTilt), 0, std::cos(kTilt));
const CloudPoint kRight = make_point(0.01, 0, 0, std::sin(kTilt), 0, std::cos(kTilt));

TEST(EdgeWeight, ConvexEdgeIsSquared) {
  EXPECT_NEAR(kNormalsOnly.directed(kLeft, kRight), 0.25F, kRounding);
  EXPECT_NEAR(kNormalsOnly.directed(kRight, kLeft), 0.25F, kRounding);
}

TEST(EdgeWeight, ConcaveEdgeIsNot) {
  CloudPoint left = kLeft;
  CloudPoint right = kRight;
  std::swap(left.x, right.x);  // the same normals, leaning towards each other
  EXPECT_NEAR(kNormalsOnly.directed(left, right), 0.5F, kRounding);
  EXPECT_NEAR(kNormalsOnly(left, right), 0.5F, kRounding);
}

TEST(EdgeWeight, DirectionDecidesByTheNormalOfTheFarEnd) {
  // n_j rises from i to j, so that edge is convex; n_i is level with it, so the way back is not.
  const CloudPoint i = make_point(0, 0, 0, 1, 0, 0);
  const CloudPoint j = make_point(0, 0, 0.01, 1, 0, 1);
  const float c = static_cast<float>(1.0 - std::sqrt(0.5));
  EXPECT_NEAR(kNormalsOnly.directed(i, j), c * c, kRounding);
  EXPECT_NEAR(kNormalsOnly.directed(j, i), c, kRounding);
  EXPECT_EQ(kNormalsOnly(i, j), kNormalsOnly.directed(i, j));
  EXPECT_EQ(kNormalsOnly(j, i), kNormalsOnly.directed(i, j));
}

TEST(EdgeWeight, LevelIsNotConvex) {
  // (p_j - p_i) . n_j = 0 exactly, in both directions.
  const CloudPoint i = make_point(0, 0, 0, 0, 0, 1);
  CloudPoint j = make_point(0.01, 0, 0, 0, 0, 1);
  j.nz = 0.75F;
  EXPECT_EQ(kNormalsOnly.directed(i, j), 0.25F);
}

TEST(EdgeWeight, NormalsTooLongByARoundingDoNotMakeItNegative) {
  CloudPoint i = make_point(0, 0, 0, 0, 0, 1);
  i.nz = std::nextafter(1.0F, 2.0F);
  const CloudPoint j = i;
  EXPECT_EQ(kNormalsOnly.directed(i, j), 0.0F);
  EXPECT_FALSE(std::signbit(kNormalsOnly.directed(i, j)));
}

TEST(EdgeWeight, OppositeNormalsWeighTwo) {
  const CloudPoint i = make_point(0, 0, 0, 0, 0, 1);
  const CloudPoint j = make_point(0.01, 0, 0, 0, 0, -1);
  EXPECT_EQ(kNormalsOnly(i, j), 2.0F);
}

CloudPoint painted(CloudPoint p, int red, int green, int blue) {
  p.red = static_cast<std::uint8_t>(red);
  p.green = static_cast<std::uint8_t>(green);
  p.blue = static_cast<std::uint8_t>(blue);
  return p;
}

TEST(EdgeWeight, ColorAddsLambdaTimesTheSquaredDistanceInTheUnitCube) {
  const CloudPoint i = painted(make_point(0, 0, 0, 0, 0, 1), 200, 100, 50);
  const CloudPoint j = painted(make_point(0.01, 0, 0, 0, 0, 1), 203, 104, 38);
  // 3^2 + 4^2 + 12^2 = 169; the normals agree.
  EXPECT_EQ(with_lambda(0.003)(i, j), static_cast<float>(0.003 / 65025.0 * 169.0));
  EXPECT_EQ(with_lambda(0.003)(j, i), with_lambda(0.003)(i, j));
  EXPECT_EQ(with_lambda(0.003).directed(i, j), with_lambda(0.003)(i, j));
  EXPECT_EQ(kNormalsOnly(i, j), 0.0F);
}

TEST(EdgeWeight, OppositeCornersOfTheColorCubeAreThreeLambdaApart) {
  const CloudPoint p = make_point(0, 0, 0, 0, 0, 1);
  EXPECT_EQ(with_lambda(0.5)(painted(p, 255, 0, 0), painted(p, 0, 255, 255)), 1.5F);
  EXPECT_EQ(with_lambda(0.5)(painted(p, 255, 255, 255), painted(p, 0, 255, 255)), 0.5F);
}

TEST(EdgeWeight, WhereAPointHasNoColorOnlyNormalsCount) {
  const CloudPoint none = painted(kLeft, 0, 0, 0);
  const CloudPoint white = painted(kRight, 255, 255, 255);
  EXPECT_EQ(with_lambda(0.5)(none, white), kNormalsOnly(none, white));
  EXPECT_EQ(with_lambda(0.5)(white, none), kNormalsOnly(white, none));
  EXPECT_EQ(with_lambda(0.5).directed(white, none), kNormalsOnly.directed(white, none));
  EXPECT_GT(with_lambda(0.5)(painted(kLeft, 0, 0, 1), white), with_lambda(0.5)(none, white));
}

TEST(EdgeWeight, ColorIsAddedBeforeTheOneRounding) {
  // c is 0.39 of a float32's last place above 1/4, the colour term 0.2: together they round up, and
  // neither would alone. No direction is convex.
  constexpr double kLastPlace = 0x1p-25;
  CloudPoint i = painted(make_point(0, 0, 0, 0, 0, 1), 1, 0, 0);
  CloudPoint j = painted(make_point(0.01, 0, 0, 0, 0, 1), 2, 0, 0);
  i.nx = 0x1p-13F;
  j.nx = -0x1.9p-14F;
  j.nz = 0.75F;
  const double color_weight = 65025.0 * 0.2 * kLastPlace;
  EXPECT_EQ(kNormalsOnly(i, j), 0.25F);
  EXPECT_EQ(with_lambda(color_weight)(i, j), std::nextafter(0.25F, 1.0F));
  EXPECT_EQ(with_lambda(color_weight).directed(i, j), std::nextafter(0.25F, 1.0F));
}

TEST(EdgeWeight, UndirectedIsTheSmallerDirectionToTheBit) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  std::array<int, 2> num_steep{};  // c <= 1, c > 1
  for (int k = 0; k < 20000; ++k) {
    // From nearly parallel normals to unrelated ones.
    const double spread = std::pow(10.0, -0.5 * (k % 9)) * 2.0;
    const auto random_point = [&] {
      return make_point(0.01 * normal(generator), 0.01 * normal(generator),
                        0.01 * normal(generator), spread * normal(generator),
                        spread * normal(generator), 1.0 + spread * normal(generator));
    };
    const auto random_color = [&] { return static_cast<int>(generator() % 256); };
    const CloudPoint a = painted(random_point(), random_color(), random_color(), random_color());
    const CloudPoint b = painted(random_point(), random_color(), random_color(), random_color());
    for (const double lambda : {0.0, 0.003, 1.0}) {
      const float smaller =
          std::min(with_lambda(lambda).directed(a, b), with_lambda(lambda).directed(b, a));
      EXPECT_EQ(with_lambda(lambda)(a, b), smaller);
      EXPECT_EQ(with_lambda(lambda)(b, a), smaller);
    }
    ++num_steep.at(normal_difference(a, b) > 1.0 ? 1 : 0);
  }
  EXPECT_GT(num_steep[0], 1000);
  EXPECT_GT(num_steep[1], 1000);
}

TEST(EdgeWeight, IsComputedInDoubleAndRoundedOnce) {
  // In float32 this c would be lost: n_i . n_j rounds to 1.
  CloudPoint i = make_point(0, 0, 0, 0, 0, 1);
  i.nx = 1e-5F;
  CloudPoint j = make_point(0, 0, -1, 0, 0, 1);
  j.nx = -1e-5F;
  const double nx = 1e-5F;
  EXPECT_EQ(kNormalsOnly.directed(i, j), static_cast<float>(1.0 - (1.0 - nx * nx)));
}

}  // namespace
}  // namespace kintsugi::segmenter
