#pragma once
// The ray of a camera's pixel.

#include "lcmtypes/geometry.hpp"
#include "segmenter/query/place_search.hpp"

namespace kintsugi::segmenter {

/// A Kinect's depth camera as its makers state it, and as every driver gives it that is not
/// calibrated: 640 x 480, f = 525, no distortion.
Intrinsics kinect_intrinsics();

/// The ray from the camera's centre through the pixel (u, v), which need not be an integer.
/// Distortion is taken out as OpenCV does it, by fixed-point iteration.
/// @param X_WC pose of the camera in the map
/// @throws std::invalid_argument when the pixel is outside the image, or so far out that the lens
///   model has no direction for it
Ray pixel_ray(const Intrinsics& intrinsics, const Pose& X_WC, double u_px, double v_px);

}  // namespace kintsugi::segmenter
