#include "lcmtypes/client/object_text.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "lcmtypes/base/text_format.hpp"

namespace kintsugi {
namespace {

/// For instance ", segments 7 12 and 5 more"; empty: there are none.
std::string segments_text(const std::vector<std::uint32_t>& ids) {
  constexpr std::size_t kMaxListed = 8;
  if (ids.empty()) return "";
  std::string text = ids.size() == 1 ? ", segment" : ", segments";
  const std::size_t num_listed = std::min(ids.size(), kMaxListed);
  for (std::size_t i = 0; i < num_listed; ++i) text += ' ' + std::to_string(ids[i]);
  return num_listed == ids.size() ? text : text + format(" and %zu more", ids.size() - num_listed);
}

/// How far the middle of the box has moved, and the angle of the rotation.
std::string motion_text(const ChangeReport& change) {
  Eigen::Vector3d now_W;
  for (int axis = 0; axis < 3; ++axis) {
    now_W[axis] = 0.5 * (double{change.box_min_W[axis]} + double{change.box_max_W[axis]});
  }
  const double distance_m = (now_W - change.motion_W.inverse() * now_W).norm();
  const double angle_deg =
      Eigen::AngleAxisd(change.motion_W.linear()).angle() * 180.0 / std::numbers::pi;
  return format(" by %.2f m and %.0f degrees", distance_m, angle_deg);
}

}  // namespace

const char* to_string(DetectionEvent event) {
  switch (event) {
    case DetectionEvent::kFound:
      return "found";
    case DetectionEvent::kConfirmed:
      return "confirmed";
    case DetectionEvent::kMoved:
      return "moved";
    case DetectionEvent::kGone:
      break;
  }
  return "gone";
}

const char* to_string(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::kNew:
      return "new";
    case ChangeKind::kGone:
      return "gone";
    case ChangeKind::kMoved:
      return "moved";
    case ChangeKind::kWithdrawn:
      break;
  }
  return "withdrawn";
}

std::string detection_text(const ObjectDetection& detection) {
  const Eigen::Vector3d t = detection.X_WO.translation();
  return format("object %d ", detection.detection) + detection.name + ' ' +
         to_string(detection.event) +
         format(": score %.2f, %d points at %.2f %.2f %.2f m", detection.score, detection.points,
                t.x(), t.y(), t.z()) +
         segments_text(detection.segment_ids) + '\n';
}

std::string change_text(const ChangeReport& change) {
  const float(&low)[3] = change.box_min_W;
  const float(&high)[3] = change.box_max_W;
  return format("change %d ", change.change) + to_string(change.kind) +
         (change.kind == ChangeKind::kMoved ? motion_text(change) : "") +
         format(": score %.2f, %d points in %.2f %.2f %.2f to %.2f %.2f %.2f m", change.score,
                change.points, low[0], low[1], low[2], high[0], high[1], high[2]) +
         segments_text(change.segment_ids) + ", against map '" + change.before + "'\n";
}

}  // namespace kintsugi
