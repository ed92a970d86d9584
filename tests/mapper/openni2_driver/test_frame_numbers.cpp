#include <cmath>

#include <gtest/gtest.h>

#include "mapper/openni2_driver/formats/frame_numbers.hpp"

namespace kintsugi::mapper {
namespace {

std::vector<TimedImage> images_at(const std::vector<double>& times_s) {
  std::vector<TimedImage> images;
  for (const double time_s : times_s)
    images.push_back({.utime = std::llround(1e6 * time_s), .has_point = false, .file = {}});
  return images;
}

bool numbered(const std::vector<double>& depth_s, const std::vector<double>& color_s = {}) {
  return has_frame_numbers({.depth = images_at(depth_s), .color = images_at(color_s)});
}

TEST(FrameNumbers, AreRecognised) {
  EXPECT_TRUE(numbered({1, 2, 3}, {1, 2, 3}));
  EXPECT_TRUE(numbered({0, 1, 2}));
  EXPECT_TRUE(numbered({0, 2, 4, 6})) << "every second frame";
  EXPECT_TRUE(numbered({1, 2, 3, 500, 501})) << "a part is missing";
}

TEST(FrameNumbers, AreNotSeconds) {
  EXPECT_FALSE(numbered({0, 1.0 / 30, 2.0 / 30}));
  EXPECT_FALSE(numbered({1, 2, 3.5}));
  EXPECT_FALSE(numbered({1, 2, 3}, {1.01, 2.01, 3.01})) << "colour has times";
  EXPECT_FALSE(numbered({5})) << "a single image tells nothing";
}

/// 1 Hz, as kintsugi-convert writes it.
TEST(FrameNumbers, AreWrittenWithoutADecimalPoint) {
  ImageLists lists{.depth = images_at({1, 2, 3}), .color = images_at({1, 2, 3})};
  EXPECT_TRUE(has_frame_numbers(lists));
  for (TimedImage& image : lists.depth) image.has_point = true;
  EXPECT_FALSE(has_frame_numbers(lists));
}

TEST(FrameNumbers, AreNotMilliseconds) { EXPECT_FALSE(numbered({0, 33, 67, 100, 133})); }

TEST(FrameNumbers, BecomeTimesToTheMicrosecond) {
  ImageLists lists{.depth = images_at({0, 1, 2, 3, 3'000'000}), .color = images_at({1})};
  replace_frame_numbers(lists);
  EXPECT_EQ(lists.depth[0].utime, 0);
  EXPECT_EQ(lists.depth[1].utime, 33'333);
  EXPECT_EQ(lists.depth[2].utime, 66'667);
  EXPECT_EQ(lists.depth[3].utime, 100'000);
  EXPECT_EQ(lists.depth[4].utime, 100'000'000'000);
  EXPECT_EQ(lists.color[0].utime, 33'333);
}

}  // namespace
}  // namespace kintsugi::mapper
