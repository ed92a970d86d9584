#include "mapper/source/frames/undistorter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::mapper {
namespace {

void require_positive(const char* name, double value) {
  require(std::isfinite(value) && value > 0.0, std::string("Intrinsics.") + name, value,
          "a finite number greater than 0");
}

}  // namespace

Undistorter::Undistorter(const Intrinsics& intrinsics) : pinhole_(intrinsics) {
  require_positive("fx", intrinsics.fx);
  require_positive("fy", intrinsics.fy);
  require_positive("width", intrinsics.width);
  require_positive("height", intrinsics.height);
  pinhole_.distortion.fill(0.0);
  if (std::ranges::all_of(intrinsics.distortion, [](double k) { return k == 0.0; })) return;

  const cv::Matx33d camera(intrinsics.fx, 0.0, intrinsics.cx,  //
                           0.0, intrinsics.fy, intrinsics.cy,  //
                           0.0, 0.0, 1.0);
  const cv::Mat distortion(1, 5, CV_64F, const_cast<double*>(intrinsics.distortion.data()));
  cv::Mat source_px;
  cv::Mat unused;
  cv::initUndistortRectifyMap(camera, distortion, cv::Matx33d::eye(), camera,
                              {intrinsics.width, intrinsics.height}, CV_32FC2, source_px, unused);
  cv::convertMaps(source_px, cv::noArray(), nearest_px_, unused, CV_16SC2, true);
  cv::convertMaps(source_px, cv::noArray(), whole_px_, fraction_, CV_16SC2, false);
}

cv::Mat_<float> Undistorter::undistort_depth(const cv::Mat_<float>& depth_m) const {
  check_size(depth_m);
  if (!active()) return depth_m;
  cv::Mat_<float> result;
  cv::remap(depth_m, result, nearest_px_, cv::noArray(), cv::INTER_NEAREST, cv::BORDER_CONSTANT,
            cv::Scalar::all(std::numeric_limits<double>::quiet_NaN()));
  return result;
}

cv::Mat_<cv::Vec3b> Undistorter::undistort_color(const cv::Mat_<cv::Vec3b>& color_rgb) const {
  check_size(color_rgb);
  if (!active()) return color_rgb;
  cv::Mat_<cv::Vec3b> result;
  cv::remap(color_rgb, result, whole_px_, fraction_, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return result;
}

void Undistorter::check_size(const cv::Mat& image) const {
  if (image.cols == pinhole_.width && image.rows == pinhole_.height) return;
  throw std::invalid_argument("image is " + std::to_string(image.cols) + "x" +
                              std::to_string(image.rows) + ", the calibration is for " +
                              std::to_string(pinhole_.width) + "x" +
                              std::to_string(pinhole_.height));
}

}  // namespace kintsugi::mapper
