#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "mapper/source/frames/undistorter.hpp"

namespace kintsugi::mapper {
namespace {

// fr1 of the TUM benchmark, the strongest distortion among the common ones, at half size.
const Intrinsics kLens{.fx = 258.65,
                       .fy = 258.25,
                       .cx = 159.3,
                       .cy = 127.65,
                       .width = 320,
                       .height = 240,
                       .distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};

/// Brown and Conrady's model: where the lens puts the ray of pixel (u, v) of the pinhole camera.
cv::Point2d distort(const Intrinsics& lens, double u, double v) {
  const double x = (u - lens.cx) / lens.fx;
  const double y = (v - lens.cy) / lens.fy;
  const auto [k1, k2, p1, p2, k3] = lens.distortion;
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double xd = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
  const double yd = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
  return {lens.fx * xd + lens.cx, lens.fy * yd + lens.cy};
}

bool inside(const Intrinsics& lens, cv::Point2d p, double margin) {
  return p.x >= margin && p.y >= margin && p.x <= lens.width - 1 - margin &&
         p.y <= lens.height - 1 - margin;
}

/// Each pixel of the distorted image tells where it is.
cv::Mat_<float> column_image() {
  cv::Mat_<float> image(kLens.height, kLens.width);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) image(y, x) = static_cast<float>(1000 * y + x);
  }
  return image;
}

TEST(Undistorter, TakesDepthFromTheNearestPixel) {
  const Undistorter undistorter(kLens);
  const cv::Mat_<float> result = undistorter.undistort_depth(column_image());
  int checked = 0;
  for (int y = 0; y < result.rows; ++y) {
    for (int x = 0; x < result.cols; ++x) {
      const cv::Point2d source = distort(kLens, x, y);
      if (!inside(kLens, source, 1.0)) continue;
      const double row = std::floor(result(y, x) / 1000.0F);
      const double column = result(y, x) - 1000.0 * row;
      // Half a pixel is the nearest; 1/32 of a pixel is the resolution of OpenCV's maps.
      ASSERT_NEAR(column, source.x, 0.5 + 1.0 / 32.0) << x << " " << y;
      ASSERT_NEAR(row, source.y, 0.5 + 1.0 / 32.0) << x << " " << y;
      ++checked;
    }
  }
  EXPECT_GT(checked, 0.9 * result.total());
}

TEST(Undistorter, InterpolatesColour) {
  cv::Mat_<cv::Vec3b> image(kLens.height, kLens.width);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image(y, x) = cv::Vec3b(static_cast<std::uint8_t>(x / 2), static_cast<std::uint8_t>(y), 7);
    }
  }
  const cv::Mat_<cv::Vec3b> result = Undistorter(kLens).undistort_color(image);
  for (int y = 0; y < result.rows; ++y) {
    for (int x = 0; x < result.cols; ++x) {
      const cv::Point2d source = distort(kLens, x, y);
      if (!inside(kLens, source, 1.0)) continue;
      // A gray level for rounding, one for the steps of x / 2.
      ASSERT_NEAR(result(y, x)[0], source.x / 2.0, 1.0) << x << " " << y;
      ASSERT_NEAR(result(y, x)[1], source.y, 1.0) << x << " " << y;
      ASSERT_EQ(result(y, x)[2], 7);
    }
  }
}

TEST(Undistorter, AgreesWithUndistortPoints) {
  const cv::Matx33d camera(kLens.fx, 0, kLens.cx, 0, kLens.fy, kLens.cy, 0, 0, 1);
  const std::vector<double> distortion(kLens.distortion.begin(), kLens.distortion.end());
  cv::Mat_<float> image(kLens.height, kLens.width, 0.0F);
  const std::vector<cv::Point2d> seen = {{40, 30}, {280, 35}, {160, 120}, {50, 200}, {270, 210}};
  for (std::size_t i = 0; i < seen.size(); ++i) {
    // A patch rather than a pixel, so that the nearest-neighbour map cannot miss it.
    image(cv::Rect(cv::Point(seen[i]) - cv::Point(2, 2), cv::Size(5, 5))) =
        static_cast<float>(i + 1);
  }
  const cv::Mat_<float> result = Undistorter(kLens).undistort_depth(image);
  std::vector<cv::Point2d> expected;
  cv::undistortPoints(seen, expected, camera, distortion, cv::noArray(), camera);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const cv::Moments moments = cv::moments(result == static_cast<float>(i + 1), true);
    // The centroid of a 5x5 patch moved by rounding of its border: below half a pixel.
    EXPECT_NEAR(moments.m10 / moments.m00, expected[i].x, 0.5);
    EXPECT_NEAR(moments.m01 / moments.m00, expected[i].y, 0.5);
  }
}

TEST(Undistorter, MarksWhatTheLensDidNotSee) {
  Intrinsics barrel = kLens;
  barrel.distortion = {0.5, 0.0, 0.0, 0.0, 0.0};  // the corners lie outside the distorted image
  const Undistorter undistorter(barrel);
  EXPECT_TRUE(std::isnan(undistorter.undistort_depth(column_image())(0, 0)));
  const cv::Mat_<cv::Vec3b> white(barrel.height, barrel.width, cv::Vec3b(255, 255, 255));
  EXPECT_EQ(undistorter.undistort_color(white)(0, 0), cv::Vec3b(0, 0, 0));
}

TEST(Undistorter, PassesImagesThroughWithoutDistortion) {
  Intrinsics pinhole = kLens;
  pinhole.distortion.fill(0.0);
  const Undistorter undistorter(pinhole);
  EXPECT_FALSE(undistorter.active());
  const cv::Mat_<float> image = column_image();
  EXPECT_EQ(undistorter.undistort_depth(image).data, image.data);
  EXPECT_EQ(Undistorter(kLens).intrinsics(), pinhole);
}

TEST(Undistorter, RefusesAnotherSizeAndBadIntrinsics) {
  EXPECT_THROW((void)Undistorter(kLens).undistort_depth(cv::Mat_<float>(10, 10)),
               std::invalid_argument);
  EXPECT_THROW((void)Undistorter(kLens).undistort_color(cv::Mat_<cv::Vec3b>(10, 10)),
               std::invalid_argument);
  Intrinsics bad = kLens;
  bad.fx = 0.0;
  EXPECT_THROW(Undistorter{bad}, std::invalid_argument);
  bad.fx = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Undistorter{bad}, std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper
