#include "viewer/core/figure/object_boxes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/drawing/text.hpp"
#include "viewer/core/figure/line.hpp"

namespace kintsugi::viewer {
namespace {

constexpr double kNear_m = 0.05;     // nearer corners have no place in the picture
constexpr double kMinExtent_px = 3;  // a smaller box, far away or in another part, is not seen

using Corners = std::array<Eigen::Vector3d, 8>;  // bit i of the index: the upper side along axis i

Corners corners_V(const DrawnObject& object, const Pose& X_VW) {
  const Pose X_VO = X_VW * object.X_WO;
  Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Eigen::Vector3d p_O;
    for (int axis = 0; axis < 3; ++axis) {
      p_O[axis] = double{(i >> axis & 1U) != 0 ? object.box_max_O[axis] : object.box_min_O[axis]};
    }
    corners.at(i) = X_VO * p_O;
  }
  return corners;
}

/// What a box covers of the plane of the picture.
struct Extent {
  cv::Rect2d box;
  double depth_m = 0.0;  ///< of its middle
};

/// Nothing: the box is not in the picture, or too small.
std::optional<Extent> extent_of(const Corners& corners, const VirtualCamera& camera) {
  Eigen::Array2d low(1e9, 1e9);
  Eigen::Array2d high = -low;
  for (const Eigen::Vector3d& p_V : corners) {
    if (p_V.z() < kNear_m) continue;
    const cv::Point2d p = project(camera.intrinsics, p_V);
    low = low.min(Eigen::Array2d(p.x, p.y));
    high = high.max(Eigen::Array2d(p.x, p.y));
  }
  if (!((high - low).maxCoeff() >= kMinExtent_px)) return std::nullopt;
  const Intrinsics& k = camera.intrinsics;
  if ((high < 0.0).any() || low.x() >= k.width || low.y() >= k.height) return std::nullopt;
  const Eigen::Array2d size = high - low;
  return Extent{{low.x(), low.y(), size.x(), size.y()},
                0.5 * (corners.front().z() + corners.back().z())};
}

/// Moved into the picture: a box around the camera reaches far out of it.
cv::Point middle_of(const Extent& extent, cv::Size picture) {
  const auto within = [](double middle, int size) {
    return static_cast<int>(std::clamp(middle, 0.0, static_cast<double>(size)));
  };
  return {within(extent.box.x + 0.5 * extent.box.width, picture.width),
          within(extent.box.y + 0.5 * extent.box.height, picture.height)};
}

double label_scale(cv::Size picture) { return std::clamp(picture.width / 1400.0, 0.35, 0.9); }

/// Moved into the picture.
cv::Rect inside(cv::Rect box, cv::Size picture) {
  box.x = std::clamp(box.x, 0, std::max(0, picture.width - box.width));
  box.y = std::clamp(box.y, 0, std::max(0, picture.height - box.height));
  return box;
}

/// With the outline of the letters, and their parts below the baseline.
cv::Rect with_outline(const cv::Rect& box) {
  const int margin = 2 + box.height / 4;
  return box - cv::Point(margin, margin) + cv::Size(2 * margin, 2 * margin);
}

/// Places for a label of this size, best first: at the top of the box, then farther above and below
/// and to the sides.
std::vector<cv::Rect> places(const Extent& extent, cv::Size letters, cv::Size picture) {
  const double top = std::clamp(extent.box.y, 0.0, static_cast<double>(picture.height));
  const cv::Point at(middle_of(extent, picture).x - letters.width / 2,
                     static_cast<int>(top) - letters.height - letters.height / 3);
  constexpr int kRows = 4;
  std::vector<cv::Rect> boxes;
  for (int row = 0; row <= kRows; ++row) {
    for (const int side : {0, -1, 1}) {
      for (const int direction : {-1, 1}) {
        const cv::Point moved(side * letters.width * 2 / 3,
                              direction * row * letters.height * 4 / 3);
        boxes.push_back(inside({at + moved, letters}, picture));
      }
    }
  }
  return boxes;
}

/// The corners of the boxes that are joined by an edge.
template <class Function>
void for_each_edge(const Corners& corners, const Function& function) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const std::size_t other = i | 1U << axis;
      if (other != i) function(corners.at(i), corners.at(other));
    }
  }
}

/// The lines of a box; what is not confirmed is dashed.
void draw_box(cv::Mat3b& image, const VirtualCamera& camera, const Corners& corners, bool is_dashed,
              const Rgb& color, int width) {
  constexpr int kDashes = 7;  // of one edge, with gaps of the same length between them
  for_each_edge(corners, [&](const Eigen::Vector3d& a_V, const Eigen::Vector3d& b_V) {
    if (!is_dashed) return draw_line(image, camera, a_V, b_V, color, width);
    const auto at = [&](int place) -> Eigen::Vector3d {
      return a_V + (b_V - a_V) * (place / (2.0 * kDashes - 1.0));
    };
    for (int i = 0; i < kDashes; ++i) {
      draw_line(image, camera, at(2 * i), at(2 * i + 1), color, width);
    }
  });
}

/// From the nearest place of the text to the middle of its object, with a dot there.
void draw_leader(cv::Mat3b& image, const cv::Rect& text, const cv::Point& middle) {
  const cv::Point from(std::clamp(middle.x, text.x, text.br().x),
                       std::clamp(middle.y, text.y, text.br().y));
  cv::line(image, from, middle, palette::kObject, 1, cv::LINE_AA);
  cv::circle(image, middle, line_width(image) + 1, palette::kObject, cv::FILLED, cv::LINE_AA);
}

}  // namespace

std::vector<ObjectLabel> place_object_labels(cv::Size picture, const VirtualCamera& camera,
                                             std::span<const DrawnObject> objects,
                                             std::span<const cv::Rect> reserved) {
  const Pose X_VW = camera.X_WV.inverse();
  std::vector<std::pair<std::size_t, Extent>> seen;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (const auto extent = extent_of(corners_V(objects[i], X_VW), camera)) {
      seen.emplace_back(i, *extent);
    }
  }
  std::ranges::stable_sort(seen, {}, [](const auto& object) { return object.second.depth_m; });
  std::vector<cv::Rect> taken(reserved.begin(), reserved.end());
  std::vector<ObjectLabel> labels;
  const double scale = label_scale(picture);
  for (const auto& [i, extent] : seen) {
    const cv::Size letters = text_size(objects[i].name, scale);
    const std::vector<cv::Rect> boxes = places(extent, letters, picture);
    const auto is_free = [&](const cv::Rect& box) {
      return std::ranges::none_of(taken, [&](const cv::Rect& t) { return (t & box).area() > 0; });
    };
    const auto free = std::ranges::find_if(boxes, is_free);
    ObjectLabel& label = labels.emplace_back(ObjectLabel{i, boxes.front(), scale, {}});
    if (free != boxes.end() && *free != boxes.front()) {
      label.box = *free;
      label.middle = middle_of(extent, picture);
    }
    taken.push_back(with_outline(label.box));
  }
  return labels;
}

void draw_objects(cv::Mat3b& image, const VirtualCamera& camera,
                  std::span<const DrawnObject> objects, std::span<const cv::Rect> reserved) {
  const Pose X_VW = camera.X_WV.inverse();
  const std::vector<ObjectLabel> labels =
      place_object_labels(image.size(), camera, objects, reserved);
  const int width = line_width(image);
  for (const ObjectLabel& label : labels) {
    const DrawnObject& object = objects[label.object];
    const Corners corners = corners_V(object, X_VW);
    const bool is_dashed = !object.is_confirmed;
    if (!is_dashed) draw_box(image, camera, corners, false, palette::kPictureTextEdge, width + 2);
    draw_box(image, camera, corners, is_dashed, palette::kObject, width);
  }
  for (const ObjectLabel& label : labels) {
    if (label.middle) draw_leader(image, label.box, *label.middle);
  }
  for (const ObjectLabel& label : labels) {
    draw_outlined_text(image, objects[label.object].name, {label.box.x, label.box.br().y},
                       label.scale, palette::kObject);
  }
}

}  // namespace kintsugi::viewer
