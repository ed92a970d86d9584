#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <opencv2/core.hpp>

namespace kintsugi::mapper {

/// The greatest value of a depth image of 16 bits: 65535 means "invalid" to some.
inline constexpr double kMaxDepthValue = 65534.0;

/// Metres as whole numbers of a unit; 0 where invalid or beyond 65534 units.
inline cv::Mat_<std::uint16_t> depth_values(const cv::Mat_<float>& depth_m, double units_per_m) {
  cv::Mat_<std::uint16_t> values(depth_m.size());
  std::transform(depth_m.begin(), depth_m.end(), values.begin(), [&](float z) -> std::uint16_t {
    const double value = std::round(static_cast<double>(z) * units_per_m);
    return value >= 0.0 && value <= kMaxDepthValue ? static_cast<std::uint16_t>(value) : 0;
  });
  return values;
}

}  // namespace kintsugi::mapper
