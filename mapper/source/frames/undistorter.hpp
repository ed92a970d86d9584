#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// Removes the lens distortion of a camera from its images, onto a pinhole camera with the same
/// fx, fy, cx, cy and size. The maps are computed once.
class Undistorter {
 public:
  /// @throws std::invalid_argument when focal lengths or sizes are not positive and finite.
  explicit Undistorter(const Intrinsics& intrinsics);

  /// The pinhole camera of the images handed out: the one given, with zero distortion.
  [[nodiscard]] const Intrinsics& intrinsics() const { return pinhole_; }

  /// False: the lens has no distortion and images pass through unchanged (the same pixels).
  [[nodiscard]] bool active() const { return !nearest_px_.empty(); }

  /// Nearest neighbour, because a mean across a depth edge is a point that does not exist. Pixels
  /// from outside the image become NaN. height x width, else std::invalid_argument.
  [[nodiscard]] cv::Mat_<float> undistort_depth(const cv::Mat_<float>& depth_m) const;

  /// Bilinear. Pixels from outside the image become black. height x width, else
  /// std::invalid_argument.
  [[nodiscard]] cv::Mat_<cv::Vec3b> undistort_color(const cv::Mat_<cv::Vec3b>& color_rgb) const;

 private:
  void check_size(const cv::Mat& image) const;

  Intrinsics pinhole_;
  // Source pixel of each pixel, in OpenCV's fixed-point form; or empty.
  cv::Mat nearest_px_;  ///< rounded
  cv::Mat whole_px_;    ///< rounded down
  cv::Mat fraction_;    ///< what that leaves, in 1/32 of a pixel
};

}  // namespace kintsugi::mapper
