#include "segmenter/objects/changes/change_files.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lcmtypes/base/atomic_file.hpp"
#include "lcmtypes/base/json_text.hpp"
#include "lcmtypes/base/ply_writer.hpp"
#include "lcmtypes/client/object_text.hpp"
#include "segmenter/objects/changes/change_picture.hpp"
#include "segmenter/objects/maps/surface_samples.hpp"

namespace kintsugi::segmenter {
namespace {

using Json = nlohmann::ordered_json;

Json numbers_of(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

Json numbers_of(const Pose& pose) {
  Json numbers = Json::array();
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      numbers.push_back(pose.matrix()(row, column));
    }
  }
  return numbers;
}

Json json_of(const MapChange& change) {
  const std::vector<CloudPoint>& points = change.points();
  Eigen::AlignedBox3f box;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const CloudPoint& point : points) {
    box.extend(position_of(point));
    sum += position_of(point).cast<double>();
  }
  const Eigen::Vector3f centroid = (sum / static_cast<double>(points.size())).cast<float>();
  Json json;
  json["id"] = change.id;
  json["kind"] = to_string(change.kind);
  json["points"] = points.size();
  json["centroid"] = numbers_of(centroid);
  json["box_min"] = numbers_of(Eigen::Vector3f(box.min()));
  json["box_max"] = numbers_of(Eigen::Vector3f(box.max()));
  if (change.kind == ChangeKind::kMoved) json["X_after_before"] = numbers_of(change.X_after_before);
  json["score"] = change.score;
  json["before_segments"] = change.before_segments;
  json["after_segments"] = change.after_segments;
  return json;
}

void write_ply(const MapChange& change, const std::filesystem::path& path) {
  PlyWriter writer(
      path,
      {{.name = "vertex",
        .properties = {"float x", "float y", "float z", "float nx", "float ny", "float nz",
                       "uchar red", "uchar green", "uchar blue", "uchar was"},
        .count = std::ssize(change.before) + std::ssize(change.after)}},
      {fmt::format("kintsugi change {}, {}, W of the map after, metres; was 1: as it "
                   "was before, 0: as it is now",
                   change.id, to_string(change.kind))});
  const auto append = [&](const std::vector<CloudPoint>& points, std::uint8_t was) {
    for (const CloudPoint& p : points) {
      writer.append(0, p.x, p.y, p.z, p.nx, p.ny, p.nz, p.red, p.green, p.blue, was);
    }
  };
  append(change.before, 1);
  append(change.after, 0);
  writer.commit();
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  AtomicFile file(path);
  file.stream() << bytes;
  file.commit();
}

std::string file_of_change(std::int64_t id) { return fmt::format("change_{}.ply", id); }

/// Other files in the folder belong to the user.
bool is_of_change(const std::string& name) {
  std::int64_t id = 0;
  const char* const digits = name.data() + std::min(name.size(), std::string("change_").size());
  const auto [end, error] = std::from_chars(digits, name.data() + name.size(), id);
  return error == std::errc() && name == file_of_change(id);
}

/// Removes what an earlier run has left: it would be taken for changes of this one.
void clean(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error("'" + folder.string() + "' cannot be made: " + error.message());
  }
  std::filesystem::remove(folder / "changes.json");
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (is_of_change(entry.path().filename().string())) old.push_back(entry.path());
  }
  for (const auto& path : old) std::filesystem::remove(path);
}

}  // namespace

std::string changes_json(const MapDifference& difference) {
  Json json;
  json["before"] = difference.before;
  json["after"] = difference.after;
  json["before_session"] = difference.before_session;
  json["after_session"] = difference.after_session;
  json["X_AB"] = numbers_of(difference.alignment.X_AB);
  json["alignment_rms_m"] = difference.alignment.rms_m;
  json["alignment_sigma_m"] = difference.alignment.sigma_m;
  json["alignment_sigma_rad"] = difference.alignment.sigma_rad;
  json["overlap"] = difference.alignment.overlap;
  json["agreement"] = difference.alignment.agreement;
  json["points_not_seen_again"] = difference.changes.not_seen_again;
  json["points_not_seen_before"] = difference.changes.not_seen_before;
  json["changes"] = Json::array();
  for (const MapChange& change : difference.changes.changes) {
    json["changes"].push_back(json_of(change));
  }
  return json_text(json, 1) + "\n";
}

void write_changes(const MapDifference& difference, const ObservedMap& after,
                   const std::filesystem::path& folder) {
  clean(folder);
  for (const MapChange& change : difference.changes.changes) {
    write_ply(change, folder / file_of_change(change.id));
  }
  write_bytes(folder / "changes.png", change_picture_png(difference.changes.changes, after));
  write_bytes(folder / "changes.json", changes_json(difference));
}

}  // namespace kintsugi::segmenter
