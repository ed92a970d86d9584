#pragma once
// Lines in space, drawn over a picture.

#include <opencv2/core.hpp>

#include "viewer/core/camera/virtual_camera.hpp"
#include "viewer/core/drawing/palette.hpp"

namespace kintsugi::viewer {

/// Pixels, proportional to the size of the picture.
int line_width(const cv::Mat3b& image);

/// Pixel of a point in front of the camera.
cv::Point2d project(const Intrinsics& intrinsics, const Eigen::Vector3d& p_V);

/// A line between two points, clipped where it passes behind the camera.
void draw_line(cv::Mat3b& image, const VirtualCamera& camera, Eigen::Vector3d a_V,
               Eigen::Vector3d b_V, const Rgb& color, int width);

}  // namespace kintsugi::viewer
