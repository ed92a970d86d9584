#include "segmenter/evaluation/objects/true_objects.hpp"

#include <stdexcept>

#include <nlohmann/json.hpp>

#include "segmenter/io/points/file_bytes.hpp"

namespace kintsugi::segmenter {
namespace {

using Json = nlohmann::json;

Pose pose_at(const Json& json, const char* key) {
  return pose_of(json.at(key).get<std::vector<double>>());
}

Eigen::Vector3d vector_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Symmetry symmetry_of(const Json& json) {
  Symmetry symmetry{.centre_G = vector_of(json.at("centre_G")), .axes = {}};
  for (const Json& axis : json.at("axes")) {
    symmetry.axes.push_back({vector_of(axis.at("direction_G")), axis.at("order").get<int>()});
  }
  return symmetry;
}

TrueObject object_of(const Json& json) {
  TrueObject object;
  object.key = json.contains("key") ? json.at("key") : json.at("key_before");
  object.model = json.at("model");
  object.kind = json.at("kind");
  object.symmetry = symmetry_of(json.at("symmetry"));
  if (json.contains("id_before")) {
    object.id_before = json.at("id_before").get<std::uint32_t>();
    object.X_SG_before = pose_at(json, "X_SG_before");
  }
  if (json.contains("id_after")) {
    object.id_after = json.at("id_after").get<std::uint32_t>();
    object.X_SG_after = pose_at(json, "X_SG_after");
  }
  return object;
}

std::vector<TrueObject> objects_of(const Json& list) {
  std::vector<TrueObject> objects;
  objects.reserve(list.size());
  for (const Json& entry : list) objects.push_back(object_of(entry));
  return objects;
}

}  // namespace

Pose pose_of(const std::vector<double>& numbers) {
  if (numbers.size() != 12) {
    throw std::invalid_argument("a pose has " + std::to_string(numbers.size()) +
                                " numbers, expected 12: the rows of 3 x 4");
  }
  Pose pose = Pose::Identity();
  for (int i = 0; i < 12; ++i) pose.matrix()(i / 4, i % 4) = numbers[static_cast<std::size_t>(i)];
  return pose;
}

TrueObjects read_true_objects(const std::filesystem::path& path) {
  try {
    const Json json = Json::parse(read_file_bytes(path));
    TrueObjects truth;
    truth.X_SW_before = pose_at(json.at("before"), "X_SW");
    truth.X_SW_after = pose_at(json.at("after"), "X_SW");
    if (json.contains("changes")) truth.changes = objects_of(json.at("changes"));
    truth.objects = objects_of(json.at("objects"));
    return truth;
  } catch (const Json::exception& error) {
    throw std::runtime_error(path.string() +
                             ": not a file of kintsugi-ground-truth --changes: " + error.what());
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  }
}

}  // namespace kintsugi::segmenter
