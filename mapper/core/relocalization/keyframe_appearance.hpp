#pragma once
// What a frame looks like, in the form in which relocalisation compares it.

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "mapper/core/frame/tracking_input.hpp"

namespace kintsugi::mapper {

/// ORB features: corners of an image with binary descriptors.
struct ImageFeatures {
  cv::Mat_<std::uint8_t> descriptors;  ///< one row of 32 bytes for each feature
  std::vector<cv::Point2f> rays_C;     ///< (x/z, y/z) of each feature
  std::vector<float> depths_m;         ///< of each feature; NaN where the depth is invalid

  int size() const { return descriptors.rows; }
};

struct KeyframeAppearance {
  /// Mean depth of each of 20x15 cells, metres; NaN where less than a quarter of a cell is valid.
  cv::Mat_<float> thumbnail_m;
  cv::Mat_<std::uint8_t> intensity;  ///< of the second finest surface's size; empty without colour
  ImageFeatures features;            ///< none without colour
};

/// With the `max_features` strongest features.
KeyframeAppearance appearance_of(const TrackingInput& frame, int max_features);

/// The thumbnail of a depth image of at least its size, metres; NaN is invalid.
cv::Mat_<float> thumbnail_of(const cv::Mat_<float>& depth_m);

/// Mean relative difference of the depths of the cells that are valid in both thumbnails; infinite
/// where these are less than two fifths of all cells.
double thumbnail_difference(const cv::Mat_<float>& a_m, const cv::Mat_<float>& b_m);

}  // namespace kintsugi::mapper
