#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "lcmtypes/messages.hpp"
#include "viewer/core/figure/object_boxes.hpp"
#include "viewer/core/map/point_chunk.hpp"
#include "viewer/core/rendering/highlight.hpp"
#include "viewer/core/rendering/splat.hpp"

namespace kintsugi::viewer {

struct CameraPanelConfig {
  bool label_ids = false;  ///< write the ids of the largest segments
  SplatConfig splat;
};

/// The largest size within `box` with the shape of the camera's image.
cv::Size camera_panel_size(const CameraView& view, cv::Size box);

/// The camera's image with the segments of the map projected into it: tinted in their colours and
/// outlined. What has no segment yet is in the image's own colours. If segments are highlighted,
/// only those are tinted, and their ids are written. While the pose of the camera is known, the
/// boxes and names of `objects` are drawn over it.
cv::Mat3b draw_camera_panel(std::span<const PointChunk> chunks, const CameraView& view,
                            cv::Size size, const Highlight& highlight,
                            std::span<const DrawnObject> objects, const CameraPanelConfig& config);

}  // namespace kintsugi::viewer
