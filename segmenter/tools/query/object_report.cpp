#include "segmenter/tools/query/object_report.hpp"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "lcmtypes/base/json_text.hpp"
#include "lcmtypes/client/object_text.hpp"
#include "lcmtypes/client/statistics_json.hpp"

namespace kintsugi::segmenter {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order a person reads them

constexpr std::string_view kRow = "{:<24} {:>9} {:<9} {:>5} {:>22} {:>31} {:>7} {:>6}  {}\n";

double age_s(const FoundObjects& found, const ObjectDetection& detection) {
  return 1e-6 * static_cast<double>(found.newest_utime - detection.utime);
}

std::string segments_text(const ObjectDetection& detection) {
  return detection.segment_ids.empty() ? "none"
                                       : fmt::format("{}", fmt::join(detection.segment_ids, " "));
}

std::string row(const FoundObjects& found, const ObjectDetection& detection) {
  const Eigen::Vector3d t = detection.X_WO.translation();
  const Eigen::Quaterniond q(detection.X_WO.linear());
  return fmt::format(kRow, detection.name, detection.detection, to_string(detection.event),
                     fmt::format("{:.2f}", detection.score),
                     fmt::format("{:.3f} {:.3f} {:.3f}", t.x(), t.y(), t.z()),
                     fmt::format("{:.4f} {:.4f} {:.4f} {:.4f}", q.x(), q.y(), q.z(), q.w()),
                     detection.points, fmt::format("{:.1f}", age_s(found, detection)),
                     segments_text(detection));
}

Json object_json(const FoundObjects& found, const ObjectDetection& detection) {
  const Eigen::Vector3d t = detection.X_WO.translation();
  const Eigen::Quaterniond q(detection.X_WO.linear());
  return {{"name", detection.name},
          {"detection", detection.detection},
          {"state", to_string(detection.event)},
          {"score", readable(detection.score)},
          {"pose",
           {{"translation", {t.x(), t.y(), t.z()}}, {"quaternion", {q.x(), q.y(), q.z(), q.w()}}}},
          {"box",
           {{"min", vector_json(detection.box_min_O)}, {"max", vector_json(detection.box_max_O)}}},
          {"points", detection.points},
          {"segments", detection.segment_ids},
          {"utime", detection.utime},
          {"age_s", age_s(found, detection)}};
}

}  // namespace

std::string objects_table(const FoundObjects& found) {
  std::string out = fmt::format("map '{}' of session {}: {} detections\n", found.map_name,
                                found.map_session, found.detections.size());
  if (found.detections.empty()) return out + "no such object found\n";
  out += fmt::format(kRow, "name", "detection", "state", "score", "translation m",
                     "quaternion x y z w", "points", "age s", "segments");
  for (const ObjectDetection& detection : found.detections) out += row(found, detection);
  return out;
}

std::string objects_json(const FoundObjects& found) {
  Json objects = Json::array();
  for (const ObjectDetection& detection : found.detections) {
    objects.push_back(object_json(found, detection));
  }
  const Json root{
      {"map",
       {{"name", found.map_name}, {"map_session", found.map_session}, {"session", found.session}}},
      {"objects", std::move(objects)}};
  return json_text(root, 1) + "\n";
}

}  // namespace kintsugi::segmenter
