#include "segmenter/objects/recognition/object_recognizer.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <span>
#include <string_view>
#include <utility>

#include <oneapi/tbb/parallel_for.h>

#include "segmenter/objects/recognition/described_surface.hpp"
#include "segmenter/objects/recognition/flat_patch.hpp"
#include "segmenter/objects/recognition/pose_search.hpp"

namespace kintsugi::segmenter {

namespace {

// So many of the objects that look like a candidate are tried: in the synthetic rooms two find what
// eight find.
constexpr std::size_t kTried = 2;
// So few objects do not tell how much the elements of descriptions vary; all of them are tried.
constexpr std::size_t kFew = 8;
// In standard deviations between views of one object, on average over all elements. Candidates are
// cut by occlusions and by segments that join other things, which simulated views are not.
constexpr float kLargestDistance = 1.25F;
constexpr float kAnyDistance = 1e6F;
constexpr std::size_t kPoses = 3;  // tried of each object
constexpr float kLeastAgreement =
    0.5F;  // of the candidate with an object: else most of it is something else

// Of the score of the best pose of a search, which is roughly refined: what agrees by less than
// half of what is needed is not the object.
constexpr float kLeastPromise = kLeastScore / 2;

// A third of what is known of an object, as when it is seen from another side; of less, too many
// other things have alike faces.
constexpr float kLeastSeen = 0.33F;
// Few objects do not tell what else a thing may be: then most of it has to be seen.
constexpr float kLeastSeenOfFew = 0.5F;
// Otherwise the object is only a part of a larger thing that has the same surface.
constexpr float kLeastOwn = 0.6F;

/// Better: more agrees, and on equal terms the one found first.
void keep_better(Placement& best, Placement placement) {
  if (placement.score() > best.score()) best = std::move(placement);
}

/// The best of the poses in which a part of the scene's surface may be the object's; nothing if
/// there is none.
std::optional<Placement> best_placement(const PreparedModel& object, const Surface& part_W,
                                        const Scene& scene) {
  std::vector<PoseHypothesis> poses = upright_poses(object, part_W, scene.up_W(), kPoses);
  std::erase_if(poses, [](const PoseHypothesis& pose) { return pose.agreement < kLeastAgreement; });
  if (poses.empty()) return std::nullopt;
  Placement best = placement_of(object, scene, poses.front());
  for (const PoseHypothesis& pose : std::span(poses).subspan(1)) {
    keep_better(best, placement_of(object, scene, pose));
  }
  return best;
}

/// Once more with all segments that are the object's.
Placement refined(const PreparedModel& object, const Scene& scene, const Placement& placement) {
  const Surface whole_W = scene.surface_W(placement.segment_ids);
  return placement_of(object, scene, refined_pose(object, whole_W, placement.X_WO));
}

/// As far as recognition is concerned.
bool are_same(const ObjectModel& a, const ObjectModel& b) {
  return a.name == b.name && a.resolution_m == b.resolution_m && a.map_session == b.map_session &&
         a.points_O == b.points_O && a.views_O == b.views_O && a.empty_O == b.empty_O;
}

std::vector<ViewDescriptor> views_of(const PreparedModel& prepared) {
  const float described_m = described_spacing_m(prepared.spacing_m);
  return descriptors_of_views({thinned(prepared.surface_O, described_m), described_m});
}

}  // namespace

/// A model with what is computed of it alone.
struct ObjectRecognizer::Known {
  Known(ObjectModel model_, float resolution_m)
      : model(std::move(model_)),
        prepared(model, std::max(model.resolution_m, resolution_m)),
        views(views_of(prepared)) {}

  ObjectModel model;
  PreparedModel prepared;
  std::vector<ViewDescriptor> views;
};

ObjectRecognizer::ObjectRecognizer(std::vector<ObjectModel> models, float resolution_m,
                                   const ObjectRecognizer* earlier)
    : resolution_m_(resolution_m), known_(models.size()) {
  if (earlier != nullptr && earlier->resolution_m_ == resolution_m) {
    std::map<std::string_view, std::shared_ptr<const Known>> by_name;
    for (const auto& known : earlier->known_) by_name.emplace(known->model.name, known);
    for (std::size_t i = 0; i < models.size(); ++i) {
      const auto known = by_name.find(models[i].name);
      if (known == by_name.end() || !are_same(known->second->model, models[i])) continue;
      known_[i] = known->second;
    }
  }
  num_prepared_ = static_cast<std::size_t>(std::ranges::count(known_, nullptr));
  oneapi::tbb::parallel_for(std::size_t{0}, models.size(), [&](std::size_t i) {
    if (known_[i]) return;
    known_[i] = std::make_shared<const Known>(std::move(models[i]), resolution_m);
  });
  std::vector<IndexedView> views;
  for (std::size_t i = 0; i < known_.size(); ++i) {
    largest_radius_m_ = std::max(largest_radius_m_, prepared(i).radius_m);
    for (const ViewDescriptor& view : known_[i]->views) views.push_back({i, view});
  }
  if (!views.empty()) index_.emplace(views);
}

const ObjectModel& ObjectRecognizer::model(std::size_t model) const {
  return known_.at(model)->model;
}

const PreparedModel& ObjectRecognizer::prepared(std::size_t model) const {
  return known_.at(model)->prepared;
}

float ObjectRecognizer::least_distance(const Candidate& candidate, const Scene& scene) const {
  const SurfaceMoments moments = scene.rough_moments(candidate);
  // A flat patch is recognised only where other segments have other colours of the object
  // (Placement::is_distinct).
  if (!index_ || moments.empty() || is_flat_patch(moments))
    return std::numeric_limits<float>::infinity();
  return index_->least_distance(
      size_and_colors(moments, described_spacing_m(scene.resolution_m())));
}

std::vector<Recognition> ObjectRecognizer::recognize(const Candidate& candidate,
                                                     const Scene& scene) const {
  if (!index_) return {};
  const SurfaceMoments moments = scene.moments(candidate);
  if (moments.empty()) return {};
  const SizeAndColors beginning =
      size_and_colors(moments, described_spacing_m(scene.resolution_m()));
  const bool is_choice = has_choice();
  if (is_choice && index_->least_distance(beginning) > kLargestDistance) return {};
  const ViewDescriptor descriptor = view_descriptor(beginning, scene.shape(candidate));
  const std::vector<ModelMatch> matches =
      is_choice ? index_->nearest(descriptor, kTried, kLargestDistance)
                : index_->nearest(descriptor, kFew, kAnyDistance);
  const Surface candidate_W = scene.surface_W(candidate);
  std::vector<Recognition> found;
  for (const ModelMatch& match : matches) {
    std::optional<Placement> placement = best_placement(prepared(match.model), candidate_W, scene);
    if (!placement || placement->score() < kLeastPromise) continue;
    refine(match.model, scene, *placement);
    if (!is_recognized(*placement)) continue;
    const std::int32_t points = placement->points;
    found.push_back({match.model, std::move(*placement), points});
  }
  return found;
}

std::optional<Placement> ObjectRecognizer::place(std::size_t model, const Surface& part_W,
                                                 const Scene& scene) const {
  std::optional<Placement> best = best_placement(prepared(model), part_W, scene);
  if (best) refine(model, scene, *best);
  return best;
}

/// The part may be only some of the object's segments.
void ObjectRecognizer::refine(std::size_t model, const Scene& scene, Placement& best) const {
  if (!best.segment_ids.empty()) keep_better(best, refined(prepared(model), scene, best));
}

Placement ObjectRecognizer::followed(std::size_t model, const Placement& last,
                                     const Scene& scene) const {
  const PreparedModel& object = prepared(model);
  Placement same = placement_of(object, scene, {.X_WO = last.X_WO, .light = last.light});
  if (same.segment_ids.empty()) return same;
  Placement moved = refined(object, scene, same);
  return moved.score() < same.score() ? same : moved;
}

std::set<std::uint32_t> ObjectRecognizer::segments_around(std::size_t model,
                                                          const Placement& placement,
                                                          const Scene& scene) const {
  return segmenter::segments_around(prepared(model), scene, placement.X_WO);
}

bool ObjectRecognizer::is_recognized(const Placement& placement) const {
  return placement.is_distinct && placement.score() >= kLeastScore &&
         placement.seen >= (has_choice() ? kLeastSeen : kLeastSeenOfFew) &&
         placement.own >= kLeastOwn && placement.color_difference <= kSameMeanColor;
}

bool ObjectRecognizer::has_choice() const { return known_.size() > kFew; }

}  // namespace kintsugi::segmenter
