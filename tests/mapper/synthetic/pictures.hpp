#pragma once
// Pictures of which every pixel is known, for tests of the sensors.

#include <algorithm>
#include <cmath>

#include "mapper/synthetic/sensors/sensor_model.hpp"

namespace kintsugi::synthetic {

/// A wall at depth z that fills the picture and faces the camera.
inline RenderedFrame flat_wall(double z_m, const Intrinsics& camera = default_intrinsics()) {
  const cv::Size size(camera.width, camera.height);
  return {Pose::Identity(),
          camera,
          cv::Mat_<float>(size, static_cast<float>(z_m)),
          cv::Mat_<cv::Vec3b>(size, cv::Vec3b(0, 0, 0)),
          cv::Mat_<cv::Vec3f>(size, cv::Vec3f(0, 0, -1)),
          cv::Mat_<std::uint16_t>(size, 1)};
}

/// The same, whose right half is at another depth.
inline RenderedFrame two_walls(double left_m, double right_m, const Intrinsics& camera) {
  RenderedFrame frame = flat_wall(left_m, camera);
  const int half = camera.width / 2;
  frame.depth_m(cv::Rect(half, 0, camera.width - half, camera.height)) =
      static_cast<float>(right_m);
  return frame;
}

inline bool same(const cv::Mat_<std::uint16_t>& a, const cv::Mat_<std::uint16_t>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

/// Mean and standard deviation of the valid pixels about z.
struct ErrorStatistics {
  double mean_m = 0.0;
  double deviation_m = 0.0;
  double count = 0.0;
};

inline ErrorStatistics errors_about(double z_m, const cv::Mat_<std::uint16_t>& depth_mm) {
  double sum = 0;
  double sum_of_squares = 0;
  double n = 0;
  for (const std::uint16_t value : depth_mm) {
    if (value == 0) continue;
    const double error_m = 1e-3 * value - z_m;
    sum += error_m;
    sum_of_squares += error_m * error_m;
    ++n;
  }
  return {sum / n, std::sqrt(sum_of_squares / n), n};
}

inline double invalid_share(const cv::Mat_<std::uint16_t>& depth_mm) {
  return 1.0 -
         static_cast<double>(cv::countNonZero(depth_mm)) / static_cast<double>(depth_mm.total());
}

}  // namespace kintsugi::synthetic
