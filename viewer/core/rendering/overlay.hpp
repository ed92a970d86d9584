#pragma once

#include <span>
#include <string>

#include <opencv2/core.hpp>

#include "viewer/core/rendering/virtual_camera.hpp"

namespace kintsugi::viewer {

/// Draws the polyline through `path_W`, cut off where it passes behind the camera. Nothing hides
/// it: the path is to be seen through walls.
void draw_path(cv::Mat3b& image, const VirtualCamera& camera,
               std::span<const Eigen::Vector3f> path_W);

/// Draws the depth camera C as a pyramid `size_m` deep.
void draw_frustum(cv::Mat3b& image, const VirtualCamera& camera, const Pose& X_WC, double size_m);

/// Draws a bar over `bar` and the text in it, as large as fits.
void draw_caption(cv::Mat3b& image, const cv::Rect& bar, const std::string& text);

/// Draws what a panel shows into its top left corner.
void draw_title(cv::Mat3b& image, const std::string& text);
/// What that covers.
cv::Rect title_box(const cv::Mat3b& image, const std::string& text);

}  // namespace kintsugi::viewer
