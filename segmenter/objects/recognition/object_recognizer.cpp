#include "segmenter/objects/recognition/object_recognizer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "segmenter/objects/recognition/pose_search.hpp"

namespace kintsugi::segmenter {

namespace {

// So many of the objects that look like a candidate are tried. Alike ones are few in a library: the
// others of one shape have other colours.
constexpr std::size_t kTried = 4;
// In standard deviations between views of one object, on average over all elements. Candidates are
// cut by occlusions and by segments that join other things, which simulated views are not.
constexpr float kLargestDistance = 1.25F;
constexpr std::size_t kPoses = 3;  // tried of each object
constexpr float kLeastAgreement =
    0.5F;  // of the candidate with an object: else most of it is something else

// A third of what is known of an object, as when it is seen from another side; of less, too many
// other things have alike faces.
constexpr float kLeastSeen = 0.33F;
// Otherwise the object is only a part of a larger thing that has the same surface.
constexpr float kLeastOwn = 0.6F;

/// Better: more agrees, and on equal terms the one found first.
void keep_better(std::optional<Placement>& best, Placement placement) {
  if (!best || placement.score() > best->score()) best = std::move(placement);
}

}  // namespace

ObjectRecognizer::ObjectRecognizer(std::vector<ObjectModel> models, float resolution_m)
    : models_(std::move(models)), resolution_m_(resolution_m) {
  std::vector<IndexedView> views;
  prepared_.reserve(models_.size());
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const float spacing_m = std::max(models_[i].resolution_m, resolution_m_);
    prepared_.push_back(std::make_unique<const PreparedModel>(models_[i], spacing_m));
    largest_radius_m_ = std::max(largest_radius_m_, prepared_[i]->radius_m);
    for (const ViewDescriptor& descriptor : descriptors_of_views(prepared_[i]->described)) {
      views.push_back({i, descriptor});
    }
  }
  if (!views.empty()) index_.emplace(views);
}

const PreparedModel& ObjectRecognizer::prepared(std::size_t model) const {
  return *prepared_.at(model);
}

std::optional<Recognition> ObjectRecognizer::recognize(std::span<const CloudPoint> candidate_W,
                                                       const MapAccess& map) const {
  if (!index_ || candidate_W.empty()) return std::nullopt;
  // Few objects do not tell how much the elements of descriptions vary; all of them are tried.
  const bool is_choice = models_.size() > kTried;
  if (is_choice && !may_be_known(candidate_W)) return std::nullopt;
  const DescribedSurface described(candidate_W, resolution_m_);
  std::optional<Recognition> best;
  for (const ModelMatch& match : index_->nearest(described.descriptor(), kTried)) {
    if (is_choice && match.distance > kLargestDistance) break;
    std::optional<Placement> placement = place(match.model, candidate_W, map);
    if (!placement || !is_recognized(*placement)) continue;
    if (best && best->placement.score() >= placement->score()) continue;
    best = Recognition{match.model, std::move(*placement)};
  }
  return best;
}

bool ObjectRecognizer::may_be_known(std::span<const CloudPoint> candidate_W) const {
  const float spacing_m = described_spacing_m(resolution_m_);
  const Surface surface = thinned(candidate_W, spacing_m);
  return !surface.empty() &&
         index_->has_near(size_and_colors(surface, spacing_m), kLargestDistance);
}

std::optional<Placement> ObjectRecognizer::place(std::size_t model,
                                                 std::span<const CloudPoint> candidate_W,
                                                 const MapAccess& map) const {
  const PreparedModel& object = prepared(model);
  const Surface seen_W = thinned(candidate_W, object.spacing_m);
  std::vector<PoseHypothesis> poses = upright_poses(object, seen_W, map.up_W, kPoses);
  std::erase_if(poses, [](const PoseHypothesis& pose) { return pose.agreement < kLeastAgreement; });
  if (poses.empty()) return std::nullopt;
  std::optional<Placement> best;
  for (const PoseHypothesis& pose : poses) keep_better(best, placement_of(object, map, pose));
  // Once more with all segments that are the object's, which may be more than the candidate.
  if (!best->segment_ids.empty()) {
    const Surface whole_W = thinned(map.points_of(best->segment_ids), object.spacing_m);
    keep_better(best, placement_of(object, map, refined_pose(object, whole_W, best->X_WO)));
  }
  return best;
}

bool is_recognized(const Placement& placement) {
  return placement.score() >= kLeastScore && placement.seen >= kLeastSeen &&
         placement.own >= kLeastOwn;
}

}  // namespace kintsugi::segmenter
