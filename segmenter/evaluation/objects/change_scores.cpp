#include "segmenter/evaluation/objects/change_scores.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

using Points = std::vector<CloudPoint>;

Truth moved(Truth truth, const Pose& X) {
  const Eigen::Isometry3f X_float = X.cast<float>();
  for (CloudPoint& p : truth.points_W) {
    const Eigen::Vector3f q = X_float * Eigen::Vector3f(p.x, p.y, p.z);
    p.x = q.x();
    p.y = q.y();
    p.z = q.z();
  }
  return truth;
}

Points points_of(const Truth& truth, std::uint32_t id) {
  Points points;
  for (std::size_t i = 0; i < truth.points_W.size(); ++i) {
    if (truth.instance_ids[i] == id) points.push_back(truth.points_W[i]);
  }
  return points;
}

/// How many of `points` have one of `cover` within the distance.
std::int64_t num_covered(const Points& points, const Points& cover, double max_distance_m) {
  if (points.empty() || cover.empty()) return 0;
  NearestNeighbours::Result nearest;
  NearestNeighbours(cover).find(points, 1, nearest);
  const auto limit = static_cast<float>(max_distance_m * max_distance_m);
  return std::ranges::count_if(nearest.squared_distances, [&](float d) { return d <= limit; });
}

class Scorer {
 public:
  Scorer(const ToldChanges& told, const TrueObjects& objects, const Truth& before,
         const Truth& after, double max_distance_m)
      : objects_(objects),
        before_(moved(before, told.X_AB)),
        after_(after),
        max_distance_m_(max_distance_m) {
    for (const TrueObject& object : objects.changes) add_expected(object);
    for (const ToldChange& change : told.changes) scores_.claims.push_back(score(change));
    std::erase_if(scores_.truth, [](const TrueOutcome& object) {
      return object.points < kSizeClasses.front().min_points && !object.is_found;
    });
  }

  ObjectScores take() { return std::move(scores_); }

 private:
  void add_expected(const TrueObject& object) {
    std::int64_t points = std::numeric_limits<std::int64_t>::max();
    if (object.id_before) points = std::min(points, count(before_, *object.id_before));
    if (object.id_after) points = std::min(points, count(after_, *object.id_after));
    scores_.truth.push_back(
        {.key = object.key, .kind = object.kind, .points = points, .name = "", .reason = ""});
  }

  static std::int64_t count(const Truth& truth, std::uint32_t id) {
    return std::ranges::count(truth.instance_ids, id);
  }

  /// Number of a changed object in the list, or -1; and how many of the points are on it.
  using Belonging = std::map<int, std::int64_t>;

  void add_belonging(const Points& points, const Truth& truth,
                     std::optional<std::uint32_t> TrueObject::*id, Belonging& belonging) const {
    if (points.empty()) return;
    for (const std::uint32_t instance : instances_at(points, truth, max_distance_m_)) {
      const auto found = std::ranges::find_if(objects_.changes, [&](const TrueObject& object) {
        return object.*id == std::optional<std::uint32_t>(instance);
      });
      const bool is_changed = found != objects_.changes.end();
      ++belonging[is_changed ? static_cast<int>(found - objects_.changes.begin()) : -1];
    }
  }

  /// The larger of the shares of its points that the change covers, of those as they were and of
  /// those as they are.
  double covered_share(const ToldChange& change, const TrueObject& object) const {
    double share = 0.0;
    const auto cover = [&](const Truth& truth, std::optional<std::uint32_t> id,
                           const Points& told) {
      if (!id) return;
      const Points own = points_of(truth, *id);
      if (own.empty()) return;
      share = std::max(share, static_cast<double>(num_covered(own, told, max_distance_m_)) /
                                  static_cast<double>(own.size()));
    };
    cover(before_, object.id_before, change.was_W);
    cover(after_, object.id_after, change.is_W);
    return share;
  }

  ClaimOutcome score(const ToldChange& change) {
    ClaimOutcome claim{.id = change.id,
                       .kind = change.kind,
                       .points = std::ssize(change.was_W) + std::ssize(change.is_W),
                       .key = "",
                       .reason = ""};
    Belonging belonging;
    add_belonging(change.was_W, before_, &TrueObject::id_before, belonging);
    add_belonging(change.is_W, after_, &TrueObject::id_after, belonging);
    const auto most = std::ranges::max_element(belonging, {}, &Belonging::value_type::second);
    if (most == belonging.end() || most->first < 0 || 2 * most->second <= claim.points) {
      claim.reason = "most of its points belong to no changed object";
      return claim;
    }
    const TrueObject& object = objects_.changes[static_cast<std::size_t>(most->first)];
    claim.key = object.key;
    const bool is_kind = object.kind == change.kind;
    if (!is_kind && object.kind != "moved") {
      claim.reason = "the object is " + object.kind;
    } else if (covered_share(change, object) < 0.5) {
      claim.reason = "less than half of the object";
    } else {
      claim.is_right = true;
      note_found(change, object, is_kind, scores_.truth[static_cast<std::size_t>(most->first)]);
    }
    return claim;
  }

  void note_found(const ToldChange& change, const TrueObject& object, bool is_kind,
                  TrueOutcome& outcome) const {
    outcome.is_found = true;
    if (!is_kind) return;
    outcome.is_found_as_kind = true;
    if (!change.X_after_before) return;
    const Pose X_WS = objects_.X_SW_after.inverse();
    outcome.error = pose_error(Pose(*change.X_after_before * X_WS * object.X_SG_before),
                               Pose(X_WS * object.X_SG_after), object.symmetry);
  }

  const TrueObjects& objects_;
  Truth before_;  // in AFTER's W
  const Truth& after_;
  double max_distance_m_;
  ObjectScores scores_;
};

}  // namespace

ObjectScores score_changes(const ToldChanges& told, const TrueObjects& objects, const Truth& before,
                           const Truth& after, double max_distance_m) {
  return Scorer(told, objects, before, after, max_distance_m).take();
}

}  // namespace kintsugi::segmenter
