#include "segmenter/evaluation/objects/told_changes.hpp"

#include <stdexcept>

#include <nlohmann/json.hpp>

#include "segmenter/evaluation/objects/true_objects.hpp"
#include "segmenter/io/ply/ply_table.hpp"
#include "segmenter/io/points/file_bytes.hpp"
#include "segmenter/io/points/file_cloud.hpp"

namespace kintsugi::segmenter {
namespace {

using Json = nlohmann::json;

void read_points(const std::filesystem::path& path, ToldChange& change) {
  const PointTable table = parse_ply_table(read_file_bytes(path), path.string());
  const auto was = table.find("was");
  if (!was) {
    throw std::runtime_error(path.string() + ": " + table.place +
                             " lacks property 'was' (1: as it was before, 0: as it is now)");
  }
  const FileCloud cloud = cloud_of(table, find_roles(table, path.string()), {}, path.string());
  for (std::size_t i = 0; i < cloud.points_W.size(); ++i) {
    (table.value(i, *was) != 0.0 ? change.was_W : change.is_W).push_back(cloud.points_W[i]);
  }
}

ToldChange change_of(const Json& json) {
  ToldChange change;
  change.id = json.at("id").get<std::int64_t>();
  change.kind = json.at("kind").get<std::string>();
  if (json.contains("X_after_before") && !json.at("X_after_before").is_null()) {
    change.X_after_before = pose_of(json.at("X_after_before").get<std::vector<double>>());
  }
  return change;
}

}  // namespace

ToldChanges read_told_changes(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "changes.json";
  ToldChanges told;
  try {
    const Json json = Json::parse(read_file_bytes(path));
    told.X_AB = pose_of(json.at("X_AB").get<std::vector<double>>());
    for (const Json& entry : json.at("changes")) told.changes.push_back(change_of(entry));
  } catch (const Json::exception& error) {
    throw std::runtime_error(path.string() + ": not a file of kintsugi-diff: " + error.what());
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  }
  for (ToldChange& change : told.changes) {
    read_points(folder / ("change_" + std::to_string(change.id) + ".ply"), change);
  }
  return told;
}

}  // namespace kintsugi::segmenter
