#pragma once
// The intensity of colour images, at several levels of detail.

#include <vector>

#include <opencv2/core.hpp>

namespace kintsugi::mapper {

/// Intensity and its image gradient.
struct IntensityMap {
  cv::Mat_<float> value;       ///< height x width, 0 to 1
  cv::Mat_<float> gradient_u;  ///< per pixel, central differences; zero at the border
  cv::Mat_<float> gradient_v;
};

/// Finest first; each level has half the width and height of the one before it.
using IntensityPyramid = std::vector<IntensityMap>;

/// Halves the image until it has the size `finest`, which is the first of `levels` levels.
/// @throws std::invalid_argument if the image is not 1, 2, 4.. times that size
IntensityPyramid intensity_pyramid(const cv::Mat_<cv::Vec3b>& color_rgb, cv::Size finest,
                                   int levels);

}  // namespace kintsugi::mapper
