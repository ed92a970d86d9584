#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "viewer/core/camera/virtual_camera.hpp"

namespace kintsugi::viewer {

/// A known object that is drawn where it was detected.
struct DrawnObject {
  std::string name;
  Pose X_WO = Pose::Identity();
  Eigen::Vector3f box_min_O = Eigen::Vector3f::Zero();  ///< metres
  Eigen::Vector3f box_max_O = Eigen::Vector3f::Zero();
  bool is_confirmed = false;
};

/// Where the name of an object is written.
struct ObjectLabel {
  std::size_t object = 0;  ///< its place among the objects
  cv::Rect box;            ///< of the text
  double scale = 0.0;
  /// The middle of the object in the picture, where the text is not at its top: a line leads there.
  std::optional<cv::Point> middle;
};

/// Places the names above the boxes of the objects, the nearest object first. No label covers
/// another or a `reserved` box where there is a free place within a few lines of text. Objects that
/// are behind the camera, outside of the picture, or too small to be seen get none.
std::vector<ObjectLabel> place_object_labels(cv::Size picture, const VirtualCamera& camera,
                                             std::span<const DrawnObject> objects,
                                             std::span<const cv::Rect> reserved);

/// Draws the boxes of the objects over the map, in full lines where they are confirmed and dashed
/// where they are not, and their names, with lines from those that are away from their boxes.
void draw_objects(cv::Mat3b& image, const VirtualCamera& camera,
                  std::span<const DrawnObject> objects, std::span<const cv::Rect> reserved);

}  // namespace kintsugi::viewer
