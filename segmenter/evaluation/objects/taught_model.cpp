#include "segmenter/evaluation/objects/taught_model.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "segmenter/evaluation/objects/true_objects.hpp"
#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/io/points/file_bytes.hpp"

namespace kintsugi::segmenter {
namespace {

std::optional<Pose> first_pose(const std::filesystem::path& path) {
  using Json = nlohmann::json;
  try {
    const Json json = Json::parse(read_file_bytes(path));
    const Json& lessons = json.at("lessons");
    if (lessons.empty() || !lessons.front().contains("X_WO")) return std::nullopt;
    return pose_of(lessons.front().at("X_WO").get<std::vector<double>>());
  } catch (const Json::exception& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  }
}

}  // namespace

std::string library_name(std::string key) {
  std::ranges::replace(key, ' ', '_');
  return key;
}

TaughtModel read_taught_model(const std::filesystem::path& library, const std::string& name) {
  const std::filesystem::path folder = library / name;
  return {.points_O = read_ply(folder / "model.ply").points_W,
          .X_WO = first_pose(folder / "object.json")};
}

}  // namespace kintsugi::segmenter
