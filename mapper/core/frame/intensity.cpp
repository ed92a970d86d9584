#include "mapper/core/frame/intensity.hpp"

#include <string>

#include <opencv2/imgproc.hpp>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::mapper {
namespace {

/// The mean of each 2x2; an odd last row or column is left out, as by half_size() of depth.
cv::Mat_<float> half_size(const cv::Mat_<float>& image) {
  const cv::Size size(image.cols / 2, image.rows / 2);
  cv::Mat_<float> half;
  cv::resize(image(cv::Rect(0, 0, 2 * size.width, 2 * size.height)), half, size, 0, 0,
             cv::INTER_AREA);
  return half;
}

IntensityMap with_gradients(const cv::Mat_<float>& value) {
  IntensityMap map{value, cv::Mat_<float>(value.size(), 0.0F), cv::Mat_<float>(value.size(), 0.0F)};
  for (int v = 1; v + 1 < value.rows; ++v) {
    for (int u = 1; u + 1 < value.cols; ++u) {
      map.gradient_u(v, u) = 0.5F * (value(v, u + 1) - value(v, u - 1));
      map.gradient_v(v, u) = 0.5F * (value(v + 1, u) - value(v - 1, u));
    }
  }
  return map;
}

std::string text(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace

IntensityPyramid intensity_pyramid(const cv::Mat_<cv::Vec3b>& color_rgb, cv::Size finest,
                                   int levels) {
  cv::Mat_<std::uint8_t> grey;
  cv::cvtColor(color_rgb, grey, cv::COLOR_RGB2GRAY);
  cv::Mat_<float> value;
  grey.convertTo(value, CV_32F, 1.0 / 255.0);
  while (value.cols / 2 >= finest.width && value.rows / 2 >= finest.height) {
    value = half_size(value);
  }
  require(value.size() == finest, "colour image is " + text(color_rgb.size()) + ", expected " +
                                      text(finest) + " times a power of two");
  IntensityPyramid pyramid{with_gradients(value)};
  while (static_cast<int>(pyramid.size()) < levels) {
    value = half_size(value);
    pyramid.push_back(with_gradients(value));
  }
  return pyramid;
}

}  // namespace kintsugi::mapper
