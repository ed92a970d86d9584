#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "mapper/core/frame/surface_pyramid.hpp"

namespace kintsugi::mapper {

/// One frame prepared for tracking and relocalisation.
struct TrackingInput {
  std::int64_t utime = 0;    ///< device time, microseconds
  SurfacePyramid surface_C;  ///< of its depth image
  /// Registered to the depth image; 1, 2, 4.. times the finest surface's width and height; empty:
  /// no colour. Copies of this struct share the pixels, so nobody may write them.
  cv::Mat_<cv::Vec3b> color_rgb;
};

}  // namespace kintsugi::mapper
