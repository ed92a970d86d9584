#include <cmath>

#include <gtest/gtest.h>

#include "mapper/source/frames/frame_converter.hpp"

namespace kintsugi::mapper {
namespace {

TEST(DepthToMetres, InvalidAndTooFarIsNan) {
  const cv::Mat_<std::uint16_t> raw =
      (cv::Mat_<std::uint16_t>(1, 6) << 0, 1, 1500, 4000, 4001, 65535);
  const cv::Mat_<float> metres = depth_to_metres(raw, 1000.0, 4.0);
  EXPECT_TRUE(std::isnan(metres(0, 0)));
  EXPECT_EQ(metres(0, 1), 0.001F);
  EXPECT_EQ(metres(0, 2), 1.5F);
  EXPECT_EQ(metres(0, 3), 4.0F);
  EXPECT_TRUE(std::isnan(metres(0, 4)));
  EXPECT_TRUE(std::isnan(metres(0, 5)));
  EXPECT_TRUE(std::isnan(depth_to_metres(raw, 1000.0, 100.0)(0, 5))) << "65535 at any range";
}

TEST(DepthToMetres, IsRightForEveryRawValueUpToTheRange) {
  cv::Mat_<std::uint16_t> raw(1, 65536);
  for (int i = 0; i < raw.cols; ++i) raw(0, i) = static_cast<std::uint16_t>(i);
  for (const double units_per_m : {1000.0, 5000.0, 10000.0}) {
    const cv::Mat_<float> metres = depth_to_metres(raw, units_per_m, 6.5);
    for (int i = 0; i < raw.cols; ++i) {
      if (i == 0 || i > 6.5 * units_per_m) {
        ASSERT_TRUE(std::isnan(metres(0, i))) << i;
      } else {
        ASSERT_FLOAT_EQ(metres(0, i), static_cast<float>(i / units_per_m));
      }
    }
  }
}

TEST(FrameConverter, KeepsTimesAndAddsNothing) {
  const Intrinsics camera{
      .fx = 10, .fy = 10, .cx = 2, .cy = 1, .width = 4, .height = 3, .distortion = {}};
  const FrameConverter converter(camera, 10000.0, 5.0);
  const RgbdFrame frame = converter.convert({.utime = 42,
                                             .frame_index = 7,
                                             .depth_raw = cv::Mat_<std::uint16_t>(3, 4, 12345),
                                             .color_rgb = {}});
  EXPECT_EQ(frame.utime, 42);
  EXPECT_EQ(frame.frame_index, 7);
  EXPECT_EQ(frame.intrinsics, camera);
  EXPECT_FLOAT_EQ(frame.depth_m(2, 3), 1.2345F);
  EXPECT_TRUE(frame.color_rgb.empty());
  EXPECT_THROW((void)converter.convert({.utime = 0,
                                        .frame_index = 0,
                                        .depth_raw = cv::Mat_<std::uint16_t>(4, 3),
                                        .color_rgb = {}}),
               std::invalid_argument);
}

TEST(FrameConverter, RefusesUnitsAndRangesThatAreNotPositive) {
  const Intrinsics camera{
      .fx = 10, .fy = 10, .cx = 2, .cy = 1, .width = 4, .height = 3, .distortion = {}};
  EXPECT_THROW(FrameConverter(camera, 0.0, 5.0), std::invalid_argument);
  EXPECT_THROW(FrameConverter(camera, 1000.0, -1.0), std::invalid_argument);
  EXPECT_THROW(FrameConverter(camera, std::nan(""), 5.0), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper
