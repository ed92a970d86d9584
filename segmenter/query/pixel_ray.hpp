#pragma once
// The ray through a pixel of a camera.

#include "lcmtypes/geometry.hpp"
#include "segmenter/query/place_search.hpp"

namespace kintsugi::segmenter {

/// The nominal intrinsics of a Kinect's depth camera, which drivers report without a calibration:
/// 640 x 480, f = 525, no distortion.
Intrinsics kinect_intrinsics();

/// @throws std::invalid_argument when the pixel (u, v), which need not be integers, is outside the
///   image
void check_pixel(const Intrinsics& intrinsics, double u_px, double v_px);

/// The ray from the camera's centre through the pixel (u, v), which need not be integers.
/// Distortion is removed by fixed-point iteration, as in OpenCV.
/// @param X_WC pose of the camera in the map
/// @throws std::invalid_argument when the pixel is outside the image, or the lens model cannot be
///   inverted there
Ray pixel_ray(const Intrinsics& intrinsics, const Pose& X_WC, double u_px, double v_px);

}  // namespace kintsugi::segmenter
