#pragma once
// The camera of an image: checks and conversions of its intrinsics.

#include <string_view>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/kernels/pinhole_camera.hpp"

namespace kintsugi::mapper {

/// The same camera in single precision. Lens distortion is ignored: see check_camera().
PinholeCamera pinhole_camera(const Intrinsics& intrinsics);

/// The camera of an image half the size (rounded down): one pixel covers 2x2 of the larger image,
/// so its centre lies between theirs, cx' = (cx + 1/2) / 2 - 1/2.
Intrinsics half_size(const Intrinsics& intrinsics);

/// @throws std::invalid_argument where a size, focal length or principal point is out of range,
/// there is lens distortion, or the pose is not finite
void check_camera(const Intrinsics& intrinsics, const Pose& X_WC);

/// @throws std::invalid_argument naming the image, if its size is not that of the intrinsics
void check_image_size(std::string_view name, cv::Size size, const Intrinsics& intrinsics);

}  // namespace kintsugi::mapper
