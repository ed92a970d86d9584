#pragma once
// Colours of labels in pictures.

#include <cmath>
#include <cstdint>
#include <numbers>

#include <opencv2/core.hpp>

namespace kintsugi::segmenter {

/// A colour that depends on the label only; neighbours in number are far apart in hue.
inline cv::Vec3d color_of_label(std::uint32_t label) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  const double turn = std::fmod(kGoldenRatio * (label + 1.0), 1.0);
  const double level = 170.0 + 75.0 * std::fmod(3.0 * kGoldenRatio * (label + 1.0), 1.0);
  const auto channel = [&](double shift) {
    return level * (0.6 + 0.4 * std::cos(2.0 * std::numbers::pi * (turn + shift)));
  };
  return {channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0)};
}

}  // namespace kintsugi::segmenter
