#include "segmenter/objects/process/detection_messages.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <sstream>

#include <nlohmann/json.hpp>

#include "lcmtypes/base/json_text.hpp"
#include "lcmtypes/client/object_text.hpp"

namespace kintsugi::segmenter {

namespace {

using Json = nlohmann::ordered_json;

Eigen::AlignedBox3f box_of(const ObjectModel& model) {
  Eigen::AlignedBox3f box;
  for (const CloudPoint& p : model.points_O) box.extend(Eigen::Vector3f(p.x, p.y, p.z));
  return box;
}

Json rows_of(const Pose& pose) {
  Json rows = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) rows.push_back(pose.matrix()(row, column));
  }
  return rows;
}

Json list_of(const float (&values)[3]) { return {values[0], values[1], values[2]}; }

}  // namespace

ObjectDetection message_of(const Detection& detection, const Detector& detector,
                           const DetectionSource& source) {
  const ObjectModel& model = detector.model(detection.recognition.model);
  const Placement& placement = detection.recognition.placement;
  ObjectDetection message;
  message.utime = source.utime;
  message.session = source.session;
  message.map_session = source.map_session;
  message.map_name = source.map;
  message.detection = detection.number;
  message.num_detections = static_cast<std::int32_t>(detector.detections().size());
  message.event_number = detection.event_number;
  message.event = detection.event;
  message.name = model.name;
  message.X_WO = placement.X_WO;
  message.score = std::clamp(placement.score(), 0.0F, 1.0F);
  const Eigen::AlignedBox3f box = box_of(model);
  for (int axis = 0; axis < 3; ++axis) {
    message.box_min_O[axis] = box.min()[axis];
    message.box_max_O[axis] = box.max()[axis];
  }
  message.points = placement.points;
  message.segment_ids = placement.segment_ids;
  message.segment_ids.resize(std::min(message.segment_ids.size(), kMaxObjectSegments));
  return message;
}

std::string detections_json(const Detector& detector, const DetectionSource& source) {
  Json json;
  json["map"] = source.map;
  json["detections"] = Json::array();
  for (const Detection& detection : detector.detections()) {
    if (detection.event == DetectionEvent::kGone) continue;
    const ObjectDetection message = message_of(detection, detector, source);
    Json entry;
    entry["detection"] = message.detection;
    entry["name"] = message.name;
    entry["score"] = message.score;
    entry["X_WO"] = rows_of(message.X_WO);
    entry["points"] = message.points;
    entry["segments"] = message.segment_ids;
    entry["box_min_O"] = list_of(message.box_min_O);
    entry["box_max_O"] = list_of(message.box_max_O);
    entry["event"] = to_string(message.event);
    entry["utime"] = detection.event_utime;
    json["detections"].push_back(std::move(entry));
  }
  return json_text(json, 1) + '\n';
}

std::string detections_text(const Detector& detector) {
  std::ostringstream text;
  text << "detection  name                      score    x, m    y, m    z, m  points  segments\n";
  text << std::fixed;
  for (const Detection& detection : detector.detections()) {
    if (detection.event == DetectionEvent::kGone) continue;
    const Placement& placement = detection.recognition.placement;
    const Eigen::Vector3d t = placement.X_WO.translation();
    text << std::setw(9) << detection.number << "  " << std::left << std::setw(24)
         << detector.model(detection.recognition.model).name << std::right << std::setprecision(2)
         << std::setw(7) << placement.score();
    for (int axis = 0; axis < 3; ++axis) text << std::setw(8) << t[axis];
    text << std::setw(8) << placement.points << ' ';
    for (const std::uint32_t id : placement.segment_ids) text << ' ' << id;
    text << '\n';
  }
  return text.str();
}

}  // namespace kintsugi::segmenter
