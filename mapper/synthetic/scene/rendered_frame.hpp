#pragma once
// What a camera would see of a scene if it made no error.

#include <cstdint>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::synthetic {

/// Images of height x width. A pixel whose ray meets no surface has depth NaN, the colour of a pale
/// sky, normal zero and kNoInstance.
struct RenderedFrame {
  Pose X_WC = Pose::Identity();
  Intrinsics intrinsics;
  cv::Mat_<float> depth_m;  ///< along C's z, of the ray through the pixel's centre
  cv::Mat_<cv::Vec3b> color_rgb;
  cv::Mat_<cv::Vec3f> normals_W;  ///< unit, outward
  cv::Mat_<std::uint16_t> instances;
};

/// A camera without lens distortion whose optical axis passes through the middle of the image.
inline Intrinsics centred_camera(int width, int height, double focal_length_px) {
  return {.fx = focal_length_px,
          .fy = focal_length_px,
          .cx = (width - 1) / 2.0,
          .cy = (height - 1) / 2.0,
          .width = width,
          .height = height,
          .distortion = {}};
}

/// VGA at the nominal focal length of the Kinect and the Xtion: 640 x 480, f = 525, no distortion.
inline Intrinsics default_intrinsics() { return centred_camera(640, 480, 525.0); }

}  // namespace kintsugi::synthetic
