#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "segmenter/objects/recognition/flat_patch.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr int kSide = 20;

/// A strip of points, bent about the y axis by this angle from its first column to its last.
Surface strip(float bend_rad) {
  Surface surface;
  for (int i = 0; i < kSide; ++i) {
    const float turn_rad = bend_rad * (static_cast<float>(i) / (kSide - 1) - 0.5F);
    for (int j = 0; j < kSide; ++j) {
      SurfacePoint point;
      point.position = {0.01F * static_cast<float>(i), 0.01F * static_cast<float>(j), 0.0F};
      point.normal = {std::sin(turn_rad), 0.0F, std::cos(turn_rad)};
      point.has_color = true;
      point.lab = {50.0F, 0.0F, 0.0F};
      surface.push_back(point);
    }
  }
  return surface;
}

TEST(FlatPatch, HasNormalsWithin15Degrees) {
  EXPECT_TRUE(is_flat(SurfaceMoments(strip(0.0F))));
  // Normals spread evenly over an angle a deviate from their mean by a / sqrt(12).
  constexpr float kLimit_rad = std::numbers::pi_v<float> / 12;
  EXPECT_TRUE(is_flat(SurfaceMoments(strip(0.9F * kLimit_rad * std::sqrt(12.0F)))));
  EXPECT_FALSE(is_flat(SurfaceMoments(strip(1.1F * kLimit_rad * std::sqrt(12.0F)))));
}

TEST(FlatPatch, OfOneColourIsPlain) {
  Surface surface = strip(0.0F);
  EXPECT_TRUE(is_plain(SurfaceMoments(surface)));
  EXPECT_TRUE(is_plain({}));
  for (std::size_t i = 0; i < surface.size(); i += 2) surface[i].lab.x() += 4.0F;
  EXPECT_TRUE(is_plain(SurfaceMoments(surface))) << "shades";
  for (std::size_t i = 0; i < surface.size(); i += 2) surface[i].lab.x() += 40.0F;
  EXPECT_FALSE(is_plain(SurfaceMoments(surface)));
  for (std::size_t i = 0; i < surface.size(); i += 2) surface[i].has_color = false;
  EXPECT_TRUE(is_plain(SurfaceMoments(surface))) << "points without a colour say nothing";
}

}  // namespace
}  // namespace kintsugi::segmenter
