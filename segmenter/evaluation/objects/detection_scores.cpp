#include "segmenter/evaluation/objects/detection_scores.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/evaluation/objects/taught_model.hpp"
#include "segmenter/io/points/file_bytes.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

using Json = nlohmann::json;

Eigen::Vector3d vector_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

void take(const Json& entry, std::map<std::int64_t, ToldDetection>& last) {
  const auto id = entry.at("detection").get<std::int64_t>();
  if (entry.value("event", "found") == "gone") {
    last.erase(id);
    return;
  }
  ToldDetection& detection = last[id];
  detection.id = id;
  detection.name = entry.at("name").get<std::string>();
  detection.X_WO = pose_of(entry.at("X_WO").get<std::vector<double>>());
  detection.box_O = {vector_of(entry.at("box_min_O")), vector_of(entry.at("box_max_O"))};
  detection.points = entry.at("points").get<std::int64_t>();
  if (entry.contains("score")) detection.score = entry.at("score").get<double>();
  if (!detection.found_utime && entry.contains("utime")) {
    detection.found_utime = entry.at("utime").get<std::int64_t>();
  }
}

/// An object of the scene that has a taught model.
struct Expected {
  /// Names in the library, any of which is right, and the object that was taught under each.
  std::map<std::string, const TrueObject*> names;
  Eigen::Vector3d centre_W;
  double reach_m = 0.0;  ///< half of its largest extent
  std::vector<CloudPoint> points_W;
};

double largest_extent_m(const std::vector<CloudPoint>& points) {
  Eigen::AlignedBox3d box;
  for (const CloudPoint& p : points) box.extend(Eigen::Vector3d(p.x, p.y, p.z));
  return box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

std::map<std::uint32_t, Expected> expected_objects(const TrueObjects& objects, const Truth& truth,
                                                   const std::set<std::string>& taught) {
  std::map<std::uint32_t, Expected> expected;
  for (const TrueObject& object : objects.objects) {
    const std::string name = library_name(object.key);
    if (!object.id_after || !taught.contains(name)) continue;
    Expected& entry = expected[*object.id_after];
    entry.names.emplace(name, &object);
    entry.centre_W = objects.X_SW_after.inverse() * object.X_SG_after * object.symmetry.centre_G;
  }
  for (std::size_t i = 0; i < truth.points_W.size(); ++i) {
    const auto found = expected.find(truth.instance_ids[i]);
    if (found != expected.end()) found->second.points_W.push_back(truth.points_W[i]);
  }
  std::erase_if(expected, [](const auto& entry) {
    return std::ssize(entry.second.points_W) < kSizeClasses.front().min_points;
  });
  for (auto& [id, entry] : expected) entry.reach_m = largest_extent_m(entry.points_W) / 2.0;
  return expected;
}

/// A detection that may be of an object.
struct Match {
  double distance_m = 0.0;
  std::size_t detection = 0;
  std::uint32_t object = 0;
};

std::vector<Match> matches(const std::vector<ToldDetection>& told,
                           const std::map<std::uint32_t, Expected>& expected) {
  std::vector<Match> found;
  for (std::size_t i = 0; i < told.size(); ++i) {
    const Eigen::Vector3d middle_W = told[i].X_WO * told[i].box_O.center();
    for (const auto& [id, object] : expected) {
      const double distance_m = (middle_W - object.centre_W).norm();
      if (!object.names.contains(told[i].name) || distance_m > object.reach_m) continue;
      found.push_back({distance_m, i, id});
    }
  }
  std::ranges::stable_sort(found, {}, &Match::distance_m);
  return found;
}

using Models = std::map<std::string, TaughtModel>;

Models read_models(const std::map<std::uint32_t, Expected>& expected,
                   const std::filesystem::path& library) {
  Models models;
  if (library.empty()) return models;
  for (const auto& [id, object] : expected) {
    for (const auto& [name, taught] : object.names) {
      if (!models.contains(name)) models.emplace(name, read_taught_model(library, name));
    }
  }
  return models;
}

/// Of the taught model in the frame of the object, which the scene defines.
std::optional<Pose> pose_in_object(const TaughtModel& model, const TrueObject& object,
                                   const TrueObjects& objects) {
  if (!model.X_WO || !object.id_before) return std::nullopt;
  return object.X_SG_before.inverse() * objects.X_SW_before * *model.X_WO;
}

/// Where a model of the object truly is; nothing: the library does not tell of any.
void add_true_pose(const Expected& expected, const TrueObjects& objects, const Models& models,
                   TrueOutcome& outcome) {
  outcome.name = expected.names.begin()->first;
  for (const auto& [name, object] : expected.names) {
    const auto model = models.find(name);
    if (model == models.end()) continue;
    const std::optional<Pose> X_GO = pose_in_object(model->second, *object, objects);
    if (!X_GO) continue;
    outcome.name = name;
    outcome.X_WO = Pose(objects.X_SW_after.inverse() * object->X_SG_after * *X_GO);
    return;
  }
}

PoseError error_of(const ToldDetection& told, const TrueObject& object, const TrueObjects& objects,
                   const Models& models, double distance_m) {
  const auto model = models.find(told.name);
  const std::optional<Pose> X_GO =
      model == models.end() ? std::nullopt : pose_in_object(model->second, object, objects);
  if (!X_GO) {
    return {.translation_m = distance_m, .rotation_deg = std::numeric_limits<double>::quiet_NaN()};
  }
  return pose_error(Pose(told.X_WO * X_GO->inverse()),
                    Pose(objects.X_SW_after.inverse() * object.X_SG_after), object.symmetry);
}

/// Mean distance of the true points from the model at the detected pose.
double surface_distance_m(const ToldDetection& detection, const std::vector<CloudPoint>& points_W,
                          const TaughtModel& model) {
  NearestNeighbours::Result nearest;
  NearestNeighbours(transformed(detection.X_WO, model.points_O)).find(points_W, 1, nearest);
  double sum_m = 0.0;
  for (const float d : nearest.squared_distances) sum_m += std::sqrt(static_cast<double>(d));
  return sum_m / static_cast<double>(points_W.size());
}

}  // namespace

std::vector<ToldDetection> read_told_detections(const std::filesystem::path& path) {
  std::map<std::int64_t, ToldDetection> last;
  try {
    const Json json = Json::parse(read_file_bytes(path));
    for (const Json& entry : json.at("detections")) take(entry, last);
  } catch (const Json::exception& error) {
    throw std::runtime_error(path.string() +
                             ": not a file of kintsugi-objects detect: " + error.what());
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path.string() + ": " + error.what());
  }
  std::vector<ToldDetection> detections;
  detections.reserve(last.size());
  for (auto& [id, detection] : last) detections.push_back(std::move(detection));
  return detections;
}

ObjectScores score_detections(const std::vector<ToldDetection>& told, const TrueObjects& objects,
                              const Truth& truth, const std::vector<std::string>& taught,
                              const std::filesystem::path& library) {
  std::set<std::string> names(taught.begin(), taught.end());
  if (names.empty()) {
    for (const ToldDetection& detection : told) names.insert(detection.name);
  }
  const auto expected = expected_objects(objects, truth, names);
  const Models models = read_models(expected, library);
  ObjectScores scores;
  std::map<std::uint32_t, std::size_t> outcome_of;
  for (const auto& [id, object] : expected) {
    outcome_of[id] = scores.truth.size();
    TrueOutcome outcome{.key = object.names.begin()->first + " #" + std::to_string(id),
                        .kind = "same object",
                        .points = std::ssize(object.points_W),
                        .instance = id,
                        .name = "",
                        .reason = ""};
    add_true_pose(object, objects, models, outcome);
    scores.truth.push_back(std::move(outcome));
  }
  for (const ToldDetection& detection : told) {
    scores.claims.push_back({.id = detection.id,
                             .kind = detection.name,
                             .points = detection.points,
                             .key = "",
                             .reason = "no such object there",
                             .score = detection.score,
                             .utime = detection.found_utime});
  }
  for (const Match& match : matches(told, expected)) {
    ClaimOutcome& claim = scores.claims[match.detection];
    TrueOutcome& outcome = scores.truth[outcome_of.at(match.object)];
    if (claim.is_right) continue;
    if (outcome.is_found) {
      claim.reason = "another detection is nearer to the object";
      continue;
    }
    claim.is_right = outcome.is_found = outcome.is_found_as_kind = true;
    claim.key = outcome.key;
    claim.reason.clear();
    const ToldDetection& detection = told[match.detection];
    const Expected& object = expected.at(match.object);
    outcome.error =
        error_of(detection, *object.names.at(detection.name), objects, models, match.distance_m);
    const auto model = models.find(detection.name);
    if (model == models.end()) continue;
    outcome.surface_m = surface_distance_m(detection, object.points_W, model->second);
  }
  return scores;
}

}  // namespace kintsugi::segmenter
