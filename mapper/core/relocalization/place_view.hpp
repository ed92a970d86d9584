#pragma once
// What of a frame is kept and compared to know a place again.

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "mapper/core/tracking/tracker.hpp"

namespace kintsugi::mapper {

/// The corners of a picture as binary descriptors (ORB).
struct ImageFeatures {
  cv::Mat_<std::uint8_t> descriptors;  ///< a row of 32 bytes for each feature
  std::vector<cv::Point2f> rays_C;     ///< (x/z, y/z) of each
  std::vector<float> depths_m;         ///< of each; NaN where it is not known

  int size() const { return descriptors.rows; }
};

struct PlaceView {
  /// Mean depth of each of 20x15 cells, metres; NaN where little of a cell is valid.
  cv::Mat_<float> thumbnail_m;
  cv::Mat_<std::uint8_t> intensity;  ///< of the second finest surface's size; empty without colour
  ImageFeatures features;            ///< none without colour
};

/// Features: the strongest ones, at most so many.
PlaceView view_of(const TrackingInput& frame, int max_features);

/// Mean relative difference of the depths of cells that both know; infinite when those are less
/// than two fifths of all: nothing to go by.
double thumbnail_difference(const cv::Mat_<float>& a_m, const cv::Mat_<float>& b_m);

}  // namespace kintsugi::mapper
