#include "segmenter/objects/recognition/object_recognizer.hpp"

#include <algorithm>
#include <utility>

#include "segmenter/objects/recognition/described_surface.hpp"
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
    const float described_m = described_spacing_m(spacing_m);
    const DescribedSurface described(thinned(prepared_[i]->surface_O, described_m), described_m);
    for (const ViewDescriptor& descriptor : descriptors_of_views(described)) {
      views.push_back({i, descriptor});
    }
  }
  if (!views.empty()) index_.emplace(views);
}

const PreparedModel& ObjectRecognizer::prepared(std::size_t model) const {
  return *prepared_.at(model);
}

std::vector<Recognition> ObjectRecognizer::recognize(const Candidate& candidate,
                                                     const Scene& scene) const {
  if (!index_) return {};
  const Surface candidate_W = scene.surface_W(candidate);
  if (candidate_W.empty()) return {};
  const SizeAndColors beginning = scene.size_and_colors(candidate);
  const bool is_choice = models_.size() > kFew;
  if (is_choice && !index_->has_near(beginning, kLargestDistance)) return {};
  const ViewDescriptor descriptor = view_descriptor(beginning, scene.shape(candidate));
  std::vector<Recognition> found;
  for (const ModelMatch& match : index_->nearest(descriptor, is_choice ? kTried : kFew)) {
    if (is_choice && match.distance > kLargestDistance) break;
    std::optional<Placement> placement = place(match.model, candidate_W, scene);
    if (!placement || !is_recognized(*placement)) continue;
    found.push_back({match.model, std::move(*placement)});
  }
  return found;
}

std::optional<Placement> ObjectRecognizer::place(std::size_t model, const Surface& part_W,
                                                 const Scene& scene) const {
  const PreparedModel& object = prepared(model);
  std::vector<PoseHypothesis> poses = upright_poses(object, part_W, scene.map().up_W(), kPoses);
  std::erase_if(poses, [](const PoseHypothesis& pose) { return pose.agreement < kLeastAgreement; });
  if (poses.empty()) return std::nullopt;
  std::optional<Placement> best;
  for (const PoseHypothesis& pose : poses) keep_better(best, placement_of(object, scene, pose));
  // Once more with all segments that are the object's, which may be more than the candidate.
  if (!best->segment_ids.empty()) {
    const Surface whole_W = scene.surface_W(best->segment_ids);
    keep_better(best, placement_of(object, scene, refined_pose(object, whole_W, best->X_WO)));
  }
  return best;
}

bool is_recognized(const Placement& placement) {
  return placement.is_distinct && placement.score() >= kLeastScore &&
         placement.seen >= kLeastSeen && placement.own >= kLeastOwn;
}

}  // namespace kintsugi::segmenter
