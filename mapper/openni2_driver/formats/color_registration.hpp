#pragma once

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/openni2_driver/formats/recording_contents.hpp"

namespace kintsugi::mapper {

/// Brings the images of a colour camera to the pixels of the depth camera.
///
/// Where the two cameras are at the same place, the depth does not matter. Otherwise each pixel of
/// the depth image looks up its colour where its surface is in the colour image; a pixel without
/// depth is taken to be as far away as the median of the others. Nothing is hidden: beside the edge
/// of a near surface, the strip that the colour camera does not see has the colour of that surface.
/// What is outside of the colour image becomes black.
class ColorRegistration {
 public:
  /// @param depth_camera its images have its lens distortion, before and after
  ColorRegistration(const Intrinsics& depth_camera, const ColorCamera& color_camera);

  [[nodiscard]] bool needs_depth() const { return needs_depth_; }

  /// @param depth_m height x width of the depth camera, metres, not > 0 where invalid; only used,
  ///   and only then not empty, when needs_depth()
  [[nodiscard]] cv::Mat_<cv::Vec3b> apply(const cv::Mat_<cv::Vec3b>& color,
                                          const cv::Mat_<float>& depth_m) const;

 private:
  [[nodiscard]] cv::Mat_<cv::Vec2f> pixels_R(const cv::Mat_<float>& depth_m) const;

  ColorCamera color_camera_;
  cv::Size smaller_;  ///< colour images are made as small, so that no pixel of theirs is skipped
  bool needs_depth_ = false;
  cv::Mat_<cv::Vec3f> rays_C_;          ///< of each pixel of the depth camera, z = 1
  cv::Mat_<cv::Vec2f> fixed_pixels_R_;  ///< in the smaller image; empty when needs_depth()
};

}  // namespace kintsugi::mapper
