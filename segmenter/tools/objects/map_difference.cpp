#include "segmenter/tools/objects/map_difference.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include <nlohmann/json.hpp>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/io/ply/ply_table.hpp"
#include "segmenter/io/points/file_bytes.hpp"
#include "segmenter/io/points/file_cloud.hpp"
#include "segmenter/io/points/point_roles.hpp"
#include "segmenter/objects/library/known_object.hpp"
#include "segmenter/objects/model/make_model.hpp"

namespace kintsugi::segmenter {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

bool shows_object(const std::string& kind) {
  return kind == "new" || kind == "gone" || kind == "moved";
}

/// Points that are there as before, or as now, in the W of the map after.
std::vector<CloudPoint> read_points(const fs::path& path, bool before) {
  const std::string bytes = read_file_bytes(path);
  const std::string name = path.string();
  const PointTable table = parse_ply_table(bytes, name);
  const std::vector<CloudPoint> all = cloud_of(table, find_roles(table, name), {}, name).points_W;
  const auto was = table.find("was");
  if (!was.has_value()) {
    throw std::runtime_error(name + ": has no property 'was', as kintsugi-diff writes it");
  }
  std::vector<CloudPoint> points_A;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if ((table.value(i, *was) != 0.0) == before) points_A.push_back(all[i]);
  }
  if (points_A.empty()) {
    throw std::runtime_error(name + ": has no points with 'was' = " + (before ? "1" : "0"));
  }
  return points_A;
}

/// A path in changes.json is that of the one who ran kintsugi-diff, or relative to its output.
fs::path found_map(const std::string& path, const fs::path& folder) {
  return fs::exists(path) || !fs::exists(folder / path) ? fs::path(path) : folder / path;
}

/// Of the W of the map before in that of the map after; what an older kintsugi-diff wrote lacks it.
Pose alignment_of(const Json& root) {
  if (!root.contains("X_AB")) return Pose::Identity();
  const auto numbers = root.at("X_AB").get<std::vector<double>>();
  std::array<double, 12> rows{};
  if (numbers.size() != rows.size()) {
    throw std::runtime_error("'X_AB' has " + std::to_string(numbers.size()) +
                             " numbers, expected 12: the rows of a 3 x 4 matrix");
  }
  std::ranges::copy(numbers, rows.begin());
  return pose_of(rows);
}

ShownChange change_of(const Json& root, const Json& entry, const fs::path& folder,
                      const fs::path& map_after) {
  ShownChange change;
  change.id = entry.at("id").get<std::int64_t>();
  change.kind = entry.at("kind").get<std::string>();
  const bool before = change.kind == "gone";
  change.segment_ids =
      entry.at(before ? "before_segments" : "after_segments").get<std::vector<std::uint32_t>>();
  std::sort(change.segment_ids.begin(), change.segment_ids.end());
  if (before) change.X_WA = alignment_of(root).inverse();
  change.map = before || map_after.empty()
                   ? found_map(root.at(before ? "before" : "after").get<std::string>(), folder)
                   : map_after;
  // What an older kintsugi-diff wrote lacks it.
  change.map_session = root.value(before ? "before_session" : "after_session", std::int64_t{0});
  return change;
}

[[noreturn]] void refuse_id(const Json& changes, std::int64_t id) {
  std::string ids;
  for (const Json& entry : changes) {
    ids += (ids.empty() ? "" : ", ") + entry.at("id").dump() + " (" +
           entry.at("kind").get<std::string>() + ")";
  }
  throw std::runtime_error("no change " + std::to_string(id) +
                           " that shows an object (new, gone or moved): it has " +
                           (ids.empty() ? "none" : ids));
}

std::vector<ShownChange> parse_changes(const std::string& text, const fs::path& folder,
                                       std::optional<std::int64_t> id, const fs::path& map_after) {
  const Json root = Json::parse(text);
  const Json& entries = root.at("changes");
  std::vector<ShownChange> changes;
  for (const Json& entry : entries) {
    if (!shows_object(entry.at("kind").get<std::string>())) continue;
    if (id.has_value() && entry.at("id").get<std::int64_t>() != *id) continue;
    changes.push_back(change_of(root, entry, folder, map_after));
  }
  if (changes.empty() && id.has_value()) refuse_id(entries, *id);
  return changes;
}

}  // namespace

std::vector<ShownChange> read_changes(const fs::path& folder, std::optional<std::int64_t> id,
                                      const fs::path& map_after) {
  const fs::path path = folder / "changes.json";
  const std::string text = read_file_bytes(path);
  std::vector<ShownChange> changes;
  try {
    changes = parse_changes(text, folder, id, map_after);
  } catch (const std::exception& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  }
  for (ShownChange& change : changes) {
    const fs::path file = folder / ("change_" + std::to_string(change.id) + ".ply");
    for (const CloudPoint& p_A : read_points(file, change.kind == "gone")) {
      change.points_W.push_back(transformed(p_A, change.X_WA));
    }
  }
  return changes;
}

}  // namespace kintsugi::segmenter
