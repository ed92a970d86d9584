#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// The longest depth that images of 16 bits can hold in units of 0.1 mm, as OpenNI2's finest are.
inline constexpr double kLongestDepth_m = 6.5;

/// One frame: undistorted, depth in metres, colour registered to depth.
struct RgbdFrame {
  std::int64_t utime = 0;         ///< device time of the depth image, microseconds
  std::int64_t frame_index = 0;   ///< as counted by the device
  Intrinsics intrinsics;          ///< without distortion
  cv::Mat_<float> depth_m;        ///< height x width, along C's z; invalid is NaN
  cv::Mat_<cv::Vec3b> color_rgb;  ///< height x width, or empty: no colour for this frame
};

}  // namespace kintsugi::mapper
