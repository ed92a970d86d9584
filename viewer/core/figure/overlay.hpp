#pragma once

#include <span>
#include <string>

#include <opencv2/core.hpp>

#include "lcmtypes/patch_pose.hpp"
#include "viewer/core/camera/frustum.hpp"
#include "viewer/core/camera/virtual_camera.hpp"

namespace kintsugi::viewer {

/// Draws the polyline through `path_W`, clipped where it passes behind the virtual camera. The path
/// is drawn over the map, so that it is visible through walls.
void draw_path(cv::Mat3b& image, const VirtualCamera& camera,
               std::span<const Eigen::Vector3f> path_W);

/// Draws a line between the two places of the camera of each loop, with a dot at both ends: they
/// may be close together.
void draw_loops(cv::Mat3b& image, const VirtualCamera& camera, std::span<const LoopLink> loops);

/// Draws the edges of the frustum of the depth camera, over the map.
void draw_frustum(cv::Mat3b& image, const VirtualCamera& camera, const Frustum& frustum);

/// Fills `bar` and writes the text into it, as large as fits.
void draw_caption(cv::Mat3b& image, const cv::Rect& bar, const std::string& text);

/// Writes the title of a panel into its top left corner.
void draw_title(cv::Mat3b& image, const std::string& text);
/// The pixels that draw_title() covers.
cv::Rect title_box(const cv::Mat3b& image, const std::string& text);

}  // namespace kintsugi::viewer
