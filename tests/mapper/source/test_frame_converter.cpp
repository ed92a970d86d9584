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

/// Where a camera of OpenCV's model sees a point.
cv::Point2d project(const Intrinsics& camera, const cv::Point3d& point) {
  const auto [k1, k2, p1, p2, k3] = camera.distortion;
  const double x = point.x / point.z;
  const double y = point.y / point.z;
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {camera.fx * (x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)) + camera.cx,
          camera.fy * (y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y) + camera.cy};
}

TEST(RowsReversed, SeeTheSamePointsAtReversedRows) {
  const Intrinsics camera{.fx = 481.2,
                          .fy = -480,
                          .cx = 319.5,
                          .cy = 200.5,
                          .width = 640,
                          .height = 480,
                          .distortion = {0.2, -0.1, 0.03, -0.02, 0.01}};
  const Intrinsics reversed = with_rows_reversed(camera);
  EXPECT_EQ(reversed.fy, 480.0);
  for (const cv::Point3d point : {cv::Point3d(0.3, 0.4, 1.0), cv::Point3d(-1.0, 0.5, 2.0)}) {
    const cv::Point2d pixel = project(camera, point);
    const cv::Point2d expected(pixel.x, camera.height - 1 - pixel.y);
    EXPECT_NEAR(cv::norm(project(reversed, point) - expected), 0.0, 1e-9);
  }
}

TEST(FrameConverter, ReversesRowsWhereYPointsUp) {
  const Intrinsics camera{
      .fx = 10, .fy = -10, .cx = 2, .cy = 0.5, .width = 4, .height = 3, .distortion = {}};
  RawFrame raw{.utime = 0,
               .frame_index = 0,
               .depth_raw = cv::Mat_<std::uint16_t>(3, 4, 1000),
               .color_rgb = cv::Mat_<cv::Vec3b>(3, 4, cv::Vec3b())};
  raw.depth_raw(0, 1) = 2000;
  raw.color_rgb(0, 1) = {1, 2, 3};
  const RgbdFrame frame = FrameConverter(camera, 1000.0, 5.0).convert(raw);
  EXPECT_EQ(frame.intrinsics, with_rows_reversed(camera));
  EXPECT_EQ(frame.intrinsics.cy, 1.5);
  EXPECT_EQ(frame.depth_m(2, 1), 2.0F);
  EXPECT_EQ(frame.depth_m(0, 1), 1.0F);
  EXPECT_EQ(frame.color_rgb(2, 1), cv::Vec3b(1, 2, 3));
  EXPECT_EQ(raw.color_rgb(0, 1), cv::Vec3b(1, 2, 3)) << "the raw image stays as it is";
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
