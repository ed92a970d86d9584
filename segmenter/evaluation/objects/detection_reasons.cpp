#include "segmenter/evaluation/objects/detection_reasons.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "segmenter/core/points/transformed_points.hpp"
#include "segmenter/evaluation/objects/taught_model.hpp"
#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

/// A surface counts as in the map where the map has a point within so many voxels: its points lie
/// one apart, and the pose is half of one off.
constexpr float kReach = 1.5F;
/// With less in common, a segment is not the object.
constexpr double kLeastIou = 0.5;

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

class Explainer {
 public:
  Explainer(const Truth& truth, const LabelledPoints& map, const std::filesystem::path& library)
      : truth_(truth),
        map_(map),
        library_(library),
        map_tree_(map.points_W),
        instances_(
            instances_at(map.points_W, truth, kReach * static_cast<double>(map.resolution_m))) {
    for (const std::uint32_t id : map.segment_ids) ++segment_sizes_[id];
  }

  std::string of_false(const ToldDetection& detection) const {
    if (library_.empty()) return "";
    const Seen seen = seen_of(detection.name, detection.X_WO);
    std::string text = "; " + percent(seen.share) + " of its surface lie on the map";
    const auto most = std::ranges::max_element(seen.instances, {},
                                               [](const auto& entry) { return entry.second; });
    if (most != seen.instances.end()) text += ", most of it on " + name_of(most->first);
    return text;
  }

  /// @param told_there the detection that was told at its place; null: none
  std::string of_missed(const TrueOutcome& object, const ToldDetection* told_there) const {
    const auto [segment, iou] = best_segment(object.instance);
    std::string text = iou < kLeastIou ? "no segment is the object" : "segmented out, not told";
    text += fmt::format("; segment {} is most like it, IoU {:.2f}", segment, iou);
    if (object.X_WO && !library_.empty()) {
      text +=
          "; " + percent(seen_of(object.name, *object.X_WO).share) + " of the model are in the map";
    }
    if (told_there != nullptr) {
      text += fmt::format("; told there: {} ({})", told_there->name, told_there->id);
    }
    return text;
  }

 private:
  struct Seen {
    double share = 0.0;  ///< of the model's points
    std::map<std::uint32_t, std::size_t> instances;
  };

  Seen seen_of(const std::string& name, const Pose& X_WO) const {
    const std::vector<CloudPoint> model_W =
        transformed(X_WO, read_taught_model(library_, name).points_O);
    NearestNeighbours::Result nearest;
    map_tree_.find(model_W, 1, nearest);
    Seen seen;
    std::size_t count = 0;
    const float reach_m = kReach * map_.resolution_m;
    for (std::size_t i = 0; i < model_W.size(); ++i) {
      if (nearest.squared_distances[i] > reach_m * reach_m) continue;
      ++count;
      ++seen.instances[instances_[nearest.indices[i]]];
    }
    seen.share = static_cast<double>(count) / static_cast<double>(model_W.size());
    return seen;
  }

  struct Match {
    std::uint32_t segment = 0;
    double iou = 0.0;
  };

  Match best_segment(std::uint32_t instance) const {
    std::map<std::uint32_t, std::size_t> common;
    std::size_t size = 0;
    for (std::size_t i = 0; i < instances_.size(); ++i) {
      if (instances_[i] != instance) continue;
      ++size;
      ++common[map_.segment_ids[i]];
    }
    Match best;
    for (const auto& [segment, count] : common) {
      const std::size_t either = size + segment_sizes_.at(segment) - count;
      const double iou = static_cast<double>(count) / static_cast<double>(either);
      if (segment != 0 && iou > best.iou) best = {segment, iou};
    }
    return best;
  }

  std::string name_of(std::uint32_t instance) const {
    const auto known = std::ranges::find(truth_.instances, instance, &TruthInstance::id);
    if (known == truth_.instances.end()) return "an unknown thing";
    return fmt::format("{} #{}", known->name.empty() ? "instance" : known->name, instance);
  }

  const Truth& truth_;
  const LabelledPoints& map_;
  const std::filesystem::path& library_;
  NearestNeighbours map_tree_;
  std::vector<std::uint32_t> instances_;
  std::map<std::uint32_t, std::size_t> segment_sizes_;
};

/// The wrong detection whose middle is nearest to the object's model and inside it; null: none.
const ToldDetection* told_at(const TrueOutcome& object, const std::vector<ToldDetection>& told,
                             const ObjectScores& scores) {
  if (!object.X_WO) return nullptr;
  const ToldDetection* nearest = nullptr;
  double distance_m = 0.0;
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (scores.claims[i].is_right) continue;
    const Eigen::Vector3d middle_W = told[i].X_WO * told[i].box_O.center();
    const double d = (middle_W - object.X_WO->translation()).norm();
    if (d > told[i].box_O.sizes().maxCoeff() / 2.0) continue;
    if (nearest != nullptr && d >= distance_m) continue;
    nearest = &told[i];
    distance_m = d;
  }
  return nearest;
}

}  // namespace

LabelledPoints read_labelled_cloud(const std::filesystem::path& path) {
  PlyCloud cloud = read_ply(path);
  if (cloud.segment_ids.empty()) {
    throw std::runtime_error(path.string() +
                             ": has no points with segment_id: expected a labelled PLY file");
  }
  LabelledPoints map{.points_W = std::move(cloud.points_W),
                     .segment_ids = std::move(cloud.segment_ids)};
  map.resolution_m = median_spacing_m(map.points_W);
  if (!(map.resolution_m > 0.0F)) {
    throw std::runtime_error(path.string() + ": too few points to estimate the resolution from");
  }
  return map;
}

void explain(const std::vector<ToldDetection>& told, const Truth& truth, const LabelledPoints& map,
             const std::filesystem::path& library, ObjectScores& scores) {
  const Explainer explainer(truth, map, library);
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (!scores.claims[i].is_right) scores.claims[i].reason += explainer.of_false(told[i]);
  }
  for (TrueOutcome& object : scores.truth) {
    if (object.is_found) continue;
    object.reason = explainer.of_missed(object, told_at(object, told, scores));
  }
}

}  // namespace kintsugi::segmenter
