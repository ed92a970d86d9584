#pragma once
// Pictures of a scene: true depth, colour, normal and instance of every pixel.

#include <cstdint>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/synthetic/scene/scene.hpp"

namespace kintsugi::synthetic {

/// VGA at the nominal focal length of the Kinect and the Xtion: 640 x 480, f = 525, no distortion.
Intrinsics default_intrinsics();

/// Every image is height x width; where a pixel's ray meets nothing: NaN, a pale sky, zero,
/// kNoInstance.
struct RenderedFrame {
  Pose X_WC = Pose::Identity();
  Intrinsics intrinsics;
  cv::Mat_<float> depth_m;  ///< along C's z, of the ray through the pixel's centre
  cv::Mat_<cv::Vec3b> color_rgb;
  cv::Mat_<cv::Vec3f> normals_W;  ///< unit, outward
  cv::Mat_<std::uint16_t> instances;
};

/// Intersects the ray of every pixel with the scene, exactly up to single precision (tests: 20 um
/// at 5 m). The result does not depend on the number of threads. Throws std::invalid_argument if
/// the intrinsics have a lens distortion, a size or focal length that is not positive.
RenderedFrame render(const Scene& scene, const Intrinsics& intrinsics, const Pose& X_WC);

}  // namespace kintsugi::synthetic
