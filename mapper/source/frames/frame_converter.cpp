#include "mapper/source/frames/frame_converter.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace kintsugi::mapper {

cv::Mat_<float> depth_to_metres(const cv::Mat_<std::uint16_t>& depth_raw, double units_per_m,
                                double max_range_m) {
  constexpr double kLargest = std::numeric_limits<std::uint16_t>::max() - 1;  // then: saturated
  constexpr double kRounding = 1e-6;  // of units: 6.5 m times 1000 is to be 6500
  const auto max_raw =
      static_cast<std::uint16_t>(std::min(kLargest, max_range_m * units_per_m + kRounding));
  const auto divisor = static_cast<float>(units_per_m);
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  cv::Mat_<float> depth_m(depth_raw.size());
  for (int y = 0; y < depth_raw.rows; ++y) {
    const std::uint16_t* raw = depth_raw[y];
    float* out = depth_m[y];
    // Apart from the test, so that the compiler makes vectors of it.
    for (int x = 0; x < depth_raw.cols; ++x) out[x] = static_cast<float>(raw[x]) / divisor;
    for (int x = 0; x < depth_raw.cols; ++x) {
      const bool valid = raw[x] != 0 && raw[x] <= max_raw;
      out[x] = valid ? out[x] : kNaN;
    }
  }
  return depth_m;
}

Intrinsics with_rows_reversed(const Intrinsics& intrinsics) {
  Intrinsics reversed = intrinsics;
  reversed.fy = -intrinsics.fy;
  reversed.cy = intrinsics.height - 1 - intrinsics.cy;
  return reversed;
}

FrameConverter::FrameConverter(const Intrinsics& intrinsics, double depth_units_per_m,
                               double max_range_m)
    : reverses_rows_(intrinsics.fy < 0.0),
      undistorter_(reverses_rows_ ? with_rows_reversed(intrinsics) : intrinsics),
      depth_units_per_m_(depth_units_per_m),
      max_range_m_(max_range_m) {
  if (!(depth_units_per_m > 0.0)) {
    throw std::invalid_argument("depth_units_per_m is " + std::to_string(depth_units_per_m) +
                                ", expected > 0");
  }
  if (!(max_range_m > 0.0)) {
    throw std::invalid_argument("max_range_m is " + std::to_string(max_range_m) + ", expected > 0");
  }
}

RgbdFrame FrameConverter::convert(const RawFrame& raw) const {
  RgbdFrame frame;
  frame.utime = raw.utime;
  frame.frame_index = raw.frame_index;
  frame.intrinsics = undistorter_.intrinsics();
  cv::Mat_<float> depth_m = depth_to_metres(raw.depth_raw, depth_units_per_m_, max_range_m_);
  cv::Mat_<cv::Vec3b> color_rgb = raw.color_rgb;
  if (reverses_rows_) {
    constexpr int kAlongY = 0;
    cv::flip(depth_m, depth_m, kAlongY);
    cv::Mat_<cv::Vec3b> reversed;  // the raw image is not ours to change
    if (!color_rgb.empty()) cv::flip(color_rgb, reversed, kAlongY);
    color_rgb = reversed;
  }
  frame.depth_m = undistorter_.undistort_depth(depth_m);
  if (!color_rgb.empty()) frame.color_rgb = undistorter_.undistort_color(color_rgb);
  return frame;
}

}  // namespace kintsugi::mapper
