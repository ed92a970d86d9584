#pragma once

#include <opencv2/core.hpp>

#include "lcmtypes/messages.hpp"
#include "viewer/core/camera/virtual_camera.hpp"
#include "viewer/core/rendering/measured_depth.hpp"

namespace kintsugi::viewer {

/// The depth camera of a view, with pictures of this size.
VirtualCamera camera_of(const CameraView& view, cv::Size size);

/// The colour image of a view in this size; without one that can be decoded its depth in shades of
/// grey, near surfaces bright, black where nothing is measured.
cv::Mat3b camera_image(const CameraView& view, cv::Size size);

/// The depth of a view in a picture of this size.
///
/// Between depths of one surface it is interpolated (inverse depth, which is linear on a plane).
/// Across an edge it is that of the nearest measurement, so that no pixel has a depth between two
/// surfaces.
MeasuredDepth measured_depth(const CameraView& view, cv::Size size);

}  // namespace kintsugi::viewer
