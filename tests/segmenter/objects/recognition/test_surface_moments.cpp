#include <cmath>
#include <cstddef>
#include <random>

#include <gtest/gtest.h>

#include "segmenter/objects/recognition/surface_moments.hpp"
#include "segmenter/objects/recognition/view_descriptor.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr float kSpacing_m = 0.01F;

/// Points on a rectangle far from the origin, in one of two colours, or without.
Surface rectangle(std::size_t columns, std::size_t rows) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> color(0, 2);
  Surface surface;
  for (std::size_t i = 0; i < columns; ++i) {
    for (std::size_t j = 0; j < rows; ++j) {
      SurfacePoint point;
      point.position = {80.0F + kSpacing_m * static_cast<float>(i),
                        -60.0F + kSpacing_m * static_cast<float>(j), 40.0F};
      point.normal = Eigen::Vector3f::UnitZ();
      const int chosen = color(random);
      point.has_color = chosen > 0;
      if (point.has_color) point.lab = {40.0F * static_cast<float>(chosen), 0.0F, 0.0F};
      surface.push_back(point);
    }
  }
  return surface;
}

TEST(SurfaceMoments, TellSizeAndColours) {
  const Surface surface = rectangle(30, 10);
  const SizeAndColors elements = size_and_colors(SurfaceMoments(surface), kSpacing_m);
  // Of n points in a row, evenly spaced: sqrt((n^2 - 1) / 12) spacings.
  const auto deviation_m = [](float n) { return kSpacing_m * std::sqrt((n * n - 1) / 12); };
  EXPECT_NEAR(elements[0], std::log(deviation_m(30) + kSpacing_m), 1e-3F);
  EXPECT_NEAR(elements[1], std::log(deviation_m(10) + kSpacing_m), 1e-3F);
  EXPECT_NEAR(elements[2], std::log(kSpacing_m), 1e-3F);
  EXPECT_NEAR(elements[3], std::log(300 * kSpacing_m * kSpacing_m), 1e-5F);
  float sum = 0.0F;
  float count = 0.0F;
  for (const SurfacePoint& point : surface) {
    if (!point.has_color) continue;
    sum += point.lab[0];
    count += 1.0F;
  }
  const float mean = sum / count;
  EXPECT_NEAR(elements[4], mean, 1e-3F);
  // Of two values, 40 and 80.
  EXPECT_NEAR(elements[7], std::sqrt((mean - 40) * (80 - mean)), 1e-3F);
  EXPECT_EQ(elements[5], 0.0F);
}

TEST(SurfaceMoments, AddUp) {
  const Surface surface = rectangle(20, 20);
  SurfaceMoments sum;
  EXPECT_TRUE(sum.empty());
  sum += SurfaceMoments(Surface(surface.begin(), surface.begin() + 150));
  sum += SurfaceMoments(Surface(surface.begin() + 150, surface.end()));
  const SizeAndColors whole = size_and_colors(SurfaceMoments(surface), kSpacing_m);
  EXPECT_TRUE(size_and_colors(sum, kSpacing_m).isApprox(whole, 1e-5F));
}

TEST(SurfaceMoments, WithoutColoursAreZero) {
  Surface surface = rectangle(4, 4);
  for (SurfacePoint& point : surface) point.has_color = false;
  EXPECT_FALSE(has_colors(size_and_colors(SurfaceMoments(surface), kSpacing_m)));
}

}  // namespace
}  // namespace kintsugi::segmenter
