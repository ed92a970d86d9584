#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "viewer/core/drawing/palette.hpp"

namespace kintsugi::viewer {
namespace {

double distance(const Rgb& a, const Rgb& b) {
  return cv::norm(cv::Vec3d(cv::Vec3b(a)) - cv::Vec3d(cv::Vec3b(b)));
}

int value(const Rgb& c) { return std::max({c.red, c.green, c.blue}); }

int chroma(const Rgb& c) { return value(c) - std::min({c.red, c.green, c.blue}); }

TEST(Rgb, BecomesAPixelOfOpenCVInBlueGreenRed) {
  const Rgb color{.red = 1, .green = 2, .blue = 3};
  EXPECT_EQ(cv::Vec3b(3, 2, 1), static_cast<cv::Vec3b>(color));
  EXPECT_EQ(cv::Scalar(3, 2, 1), static_cast<cv::Scalar>(color));
}

TEST(SegmentColor, IsTheSameForTheSameIdInEveryRun) {
  // Recorded values: a change of the colours would change every picture.
  EXPECT_EQ(palette::kUnlabelledPoint, segment_color(kNoSegment));
  EXPECT_EQ((Rgb{45, 95, 216}), segment_color(1));
  EXPECT_EQ((Rgb{228, 110, 107}), segment_color(123'456));
  EXPECT_EQ((Rgb{216, 94, 182}), segment_color(4'294'967'295U));
}

TEST(SegmentColor, IsNeverGreyNorNearlyBlack) {
  for (std::uint32_t id = 1; id < 20'000; ++id) {
    EXPECT_GE(chroma(segment_color(id)), 70) << id;
    EXPECT_GE(value(segment_color(id)), 170) << id;
  }
}

TEST(SegmentColor, DiffersClearlyBetweenNeighbouringIds) {
  for (std::uint32_t id = 1; id < 20'000; ++id) {
    for (std::uint32_t step = 1; step <= 4; ++step) {
      EXPECT_GE(distance(segment_color(id), segment_color(id + step)), 40.0) << id << ", " << step;
    }
  }
}

TEST(SegmentColor, SpreadsOverTheHues) {
  // Which of red, green and blue is largest: each a third of the hue circle.
  std::array<int, 3> largest{};
  for (std::uint32_t id = 1; id <= 3000; ++id) {
    const cv::Vec3b c = segment_color(id);
    ++largest[static_cast<std::size_t>(std::max_element(c.val, c.val + 3) - c.val)];
  }
  for (const int count : largest) EXPECT_NEAR(1000, count, 30);
}

}  // namespace
}  // namespace kintsugi::viewer
