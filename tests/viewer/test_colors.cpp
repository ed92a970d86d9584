#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "viewer/core/drawing/colors.hpp"

namespace kintsugi::viewer {
namespace {

double distance(const Color& a, const Color& b) { return cv::norm(cv::Vec3d(a) - cv::Vec3d(b)); }

int chroma(const Color& c) { return std::max({c[0], c[1], c[2]}) - std::min({c[0], c[1], c[2]}); }

TEST(SegmentColor, IsTheSameForTheSameIdInEveryRun) {
  // Recorded values: a change of the colours is a change that people see.
  EXPECT_EQ(kUnlabelledColor, segment_color(kNoSegment));
  EXPECT_EQ(Color(216, 95, 45), segment_color(1));
  EXPECT_EQ(Color(107, 110, 228), segment_color(123'456));
  EXPECT_EQ(Color(182, 94, 216), segment_color(4'294'967'295U));
}

TEST(SegmentColor, IsNeverGreyNorNearlyBlack) {
  for (std::uint32_t id = 1; id < 20'000; ++id) {
    const Color c = segment_color(id);
    EXPECT_GE(chroma(c), 70) << id;
    EXPECT_GE(std::max({c[0], c[1], c[2]}), 170) << id;
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
    const Color c = segment_color(id);
    ++largest[static_cast<std::size_t>(std::max_element(c.val, c.val + 3) - c.val)];
  }
  for (const int count : largest) EXPECT_NEAR(1000, count, 30);
}

}  // namespace
}  // namespace kintsugi::viewer
