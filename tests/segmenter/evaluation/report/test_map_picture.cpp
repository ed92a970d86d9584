#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "segmenter/evaluation/report/map_picture.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr float kResolution_m = 0.01F;

/// A square of one metre at height y, whose normals point up (-1) or down (1).
void append_square(float y, float normal_y, std::vector<CloudPoint>& points_W) {
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 100; ++k) {
      points_W.push_back({.x = kResolution_m * static_cast<float>(i),
                          .y = y,
                          .z = kResolution_m * static_cast<float>(k),
                          .ny = normal_y});
    }
  }
}

cv::Mat3b picture_of(const std::vector<CloudPoint>& points_W,
                     const std::vector<std::uint32_t>& labels) {
  const std::string png = map_picture_png(points_W, labels, kResolution_m);
  return cv::imdecode(std::vector<unsigned char>(png.begin(), png.end()), cv::IMREAD_COLOR);
}

/// Colours other than the white of the background.
std::set<std::tuple<int, int, int>> colors_of(const cv::Mat3b& picture) {
  std::set<std::tuple<int, int, int>> colors;
  for (const cv::Vec3b& pixel : picture) {
    if (pixel != cv::Vec3b(255, 255, 255)) colors.emplace(pixel[0], pixel[1], pixel[2]);
  }
  return colors;
}

TEST(MapPicture, EachSegmentHasAColour) {
  std::vector<CloudPoint> floor_W;
  append_square(0.0F, -1.0F, floor_W);
  std::vector<std::uint32_t> labels(floor_W.size(), 0);
  for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = static_cast<std::uint32_t>(i / 2500);
  EXPECT_EQ(colors_of(picture_of(floor_W, labels)).size(), 4U);
}

TEST(MapPicture, FloorIsSeenThroughTheCeilingAndHiddenByATable) {
  std::vector<CloudPoint> points_W;
  append_square(0.0F, -1.0F, points_W);
  std::vector<std::uint32_t> labels(points_W.size(), 0);
  const auto only_floor = colors_of(picture_of(points_W, labels));
  append_square(-2.0F, 1.0F, points_W);
  labels.resize(points_W.size(), 1);
  EXPECT_EQ(colors_of(picture_of(points_W, labels)), only_floor);
  append_square(-0.001F, -1.0F, points_W);
  labels.resize(points_W.size(), 2);
  const auto with_table = colors_of(picture_of(points_W, labels));
  EXPECT_EQ(with_table.size(), 2U) << "the floor only at the edge";
}

TEST(MapPicture, WhatIsOnlySeenFromBehindIsDrawn) {
  std::vector<CloudPoint> ceiling_W;
  append_square(-2.0F, 1.0F, ceiling_W);
  const std::vector<std::uint32_t> labels(ceiling_W.size(), 0);
  EXPECT_EQ(colors_of(picture_of(ceiling_W, labels)).size(), 1U);
}

TEST(MapPicture, NoPointsNoPicture) { EXPECT_EQ(map_picture_png({}, {}, kResolution_m), ""); }

TEST(MapPicture, EveryPointNeedsALabel) {
  const std::vector<CloudPoint> point_W(1);
  EXPECT_THROW(map_picture_png(point_W, {}, kResolution_m), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::segmenter
