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

#include "segmenter/io/ply/ply_reader.hpp"
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
  if (!detection.found_utime && entry.contains("utime")) {
    detection.found_utime = entry.at("utime").get<std::int64_t>();
  }
}

/// An object of the scene that has a taught model.
struct Expected {
  std::set<std::string> names;  ///< any of which is right
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
    entry.names.insert(name);
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

/// Mean distance of the true points from the model at the detected pose.
double surface_distance_m(const ToldDetection& detection, const std::vector<CloudPoint>& points_W,
                          const std::filesystem::path& library) {
  std::vector<CloudPoint> model_W = read_ply(library / detection.name / "model.ply").points_W;
  const Eigen::Isometry3f X_WO = detection.X_WO.cast<float>();
  for (CloudPoint& p : model_W) {
    const Eigen::Vector3f q = X_WO * Eigen::Vector3f(p.x, p.y, p.z);
    p.x = q.x();
    p.y = q.y();
    p.z = q.z();
  }
  NearestNeighbours::Result nearest;
  NearestNeighbours(model_W).find(points_W, 1, nearest);
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

std::string library_name(std::string key) {
  std::ranges::replace(key, ' ', '_');
  return key;
}

ObjectScores score_detections(const std::vector<ToldDetection>& told, const TrueObjects& objects,
                              const Truth& truth, const std::vector<std::string>& taught,
                              const std::filesystem::path& library) {
  std::set<std::string> names(taught.begin(), taught.end());
  if (names.empty()) {
    for (const ToldDetection& detection : told) names.insert(detection.name);
  }
  const auto expected = expected_objects(objects, truth, names);
  ObjectScores scores;
  std::map<std::uint32_t, std::size_t> outcome_of;
  for (const auto& [id, object] : expected) {
    outcome_of[id] = scores.truth.size();
    scores.truth.push_back({.key = *object.names.begin() + " #" + std::to_string(id),
                            .kind = "same object",
                            .points = std::ssize(object.points_W)});
  }
  for (const ToldDetection& detection : told) {
    scores.claims.push_back({.id = detection.id,
                             .kind = detection.name,
                             .points = detection.points,
                             .key = "",
                             .reason = "no such object there",
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
    outcome.error = PoseError{.translation_m = match.distance_m};
    if (library.empty()) continue;
    outcome.surface_m =
        surface_distance_m(told[match.detection], expected.at(match.object).points_W, library);
  }
  return scores;
}

}  // namespace kintsugi::segmenter
