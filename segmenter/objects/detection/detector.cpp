#include "segmenter/objects/detection/detector.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <oneapi/tbb/task_arena.h>

namespace kintsugi::segmenter {

namespace {

// A detection that still holds so long after it was found is confirmed. The camera, at walking
// pace, has seen the rest of an object by then.
constexpr std::int64_t kConfirmed_us = 1'000'000;

// Of logarithms: 10 %, less than things of one place differ.
constexpr float kSameLight = 0.1F;

// Segments that are examined at once, for each core: each has some candidates, so that all cores
// have work, and what is found is told soon, after some tens of milliseconds.
constexpr std::size_t kManyOfCore = 2;

// As a distance, see WaitingSegments::rank(): after all that may be an object, and before what
// hardly is one, of which the distance is infinite.
constexpr float kAfterOthers = std::numeric_limits<float>::max();

// Of the points of an object: what is seen in n parts is searched for log2(n) times.
constexpr std::int32_t kMuchMore = 2;

bool is_same_light(const Eigen::Vector3f& log_change) {
  return log_change.cwiseAbs().maxCoeff() < kSameLight;
}

bool is_active(const Detection& detection) { return detection.event != DetectionEvent::kGone; }

/// Of one object, or of one surface: if one holds, the other may not.
bool are_rivals(const Recognition& a, const Recognition& b) {
  return a.model == b.model || share_segments(a, b);
}

bool is_same(const Placement& a, const Placement& b) {
  return a.X_WO.matrix() == b.X_WO.matrix() && a.segment_ids == b.segment_ids;
}

}  // namespace

Detector::Detector(std::shared_ptr<const ObjectRecognizer> recognizer, std::int64_t map_session)
    : recognizer_(std::move(recognizer)),
      scene_(recognizer_->resolution_m()),
      observed_(recognizer_->resolution_m()),
      recognitions_(*recognizer_, scene_, map_session) {}

Detector::Detector(std::vector<ObjectModel> models, float resolution_m, std::int64_t map_session)
    : Detector(std::make_shared<const ObjectRecognizer>(std::move(models), resolution_m),
               map_session) {}

void Detector::set_piece(std::int32_t id, LabelledMap::Points points_W,
                         std::vector<std::uint32_t> segment_ids, std::int64_t utime) {
  utime_ = std::max(utime_, utime);
  is_checking_all_ = false;
  const std::set<std::uint32_t> changed =
      scene_.set_piece(id, std::move(points_W), std::move(segment_ids));
  if (!changed.empty()) recognitions_.forget_candidates();
  std::set<std::uint32_t> changed_much;
  for (const std::uint32_t segment : changed) {
    if (waiting_.has_changed_much(segment, map().num_points(segment))) changed_much.insert(segment);
    if (map().num_points(segment) > 0) {
      wait_for(segment);
    } else {
      waiting_.erase(segment);  // there is nothing to be examined
    }
  }
  // What was recognised depends on all of its segments, also on those that are gone.
  for (const std::uint32_t seed : recognitions_.seeds_of(changed_much)) wait_for(seed, true);
  for (const std::uint32_t seed : recognitions_.seeds_of(changed)) wait_for(seed);
}

bool Detector::set_views(std::span<const MapView> views) {
  if (std::ranges::equal(views, observed_.views())) return false;
  observed_.clear();
  add_views(views);
  return true;
}

void Detector::add_views(std::span<const MapView> views) {
  for (const MapView& view : views) observed_.add(view);
  scene_.set_observed(observed_.empty() ? nullptr : &observed_);
}

void Detector::examine_all() {
  // When it begins again, not all is recognised that was before.
  if (!is_checking_all_) is_light_expected_ = expects_light();
  is_light_settled_ = false;
  is_checking_all_ = true;
  begin_again({});
}

/// What was recognised before tells the light of the scene, or something was told and nothing more
/// can tell another light.
bool Detector::expects_light() const {
  if (!recognitions_.may_tell_light()) return !detections_.empty();
  const std::optional<LightChange> change = recognitions_.light();
  return change && is_same_light(change->log_gain) && scene_.light().log_gain.isZero();
}

void Detector::begin_again(const LightChange& light) {
  for (Detection& detection : detections_) {  // its light is beside that of the scene
    detection.recognition.placement.light.log_gain += scene_.light().log_gain - light.log_gain;
  }
  scene_.set_light(light);
  recognitions_.forget_all();
  waiting_.clear();
  for (const std::uint32_t segment : map().segments()) wait_for(segment);
}

/// When the light of the map becomes known and is another one, all is examined in it once more.
void Detector::settle_light() {
  if (is_light_settled_) return;
  const std::optional<LightChange> change = recognitions_.light();
  if (!change) return;
  is_light_settled_ = true;
  if (is_same_light(change->log_gain)) return;
  LightChange light;
  light.log_gain = scene_.light().log_gain + change->log_gain;
  begin_again(light);
}

void Detector::wait_for(std::uint32_t segment, bool is_urgent) {
  waiting_.add(segment, map().num_points(segment), utime_, is_urgent);
}

std::optional<std::int64_t> Detector::examine_next() {
  if (waiting_.empty()) return std::nullopt;
  rank_waiting(false);
  const WaitingSegments::Next next = waiting_.pop();
  if (is_checking_all_ || !follow(next.segment)) examine(std::span(&next.segment, 1));
  return next.since_us;
}

std::optional<std::int64_t> Detector::examine_many() {
  if (waiting_.empty()) return std::nullopt;
  rank_waiting(true);
  std::int64_t since_us = std::numeric_limits<std::int64_t>::max();
  std::vector<std::uint32_t> segments;
  while (segments.size() < most_at_once() && !waiting_.empty()) {
    const WaitingSegments::Next next = waiting_.pop();
    segments.push_back(next.segment);
    since_us = std::min(since_us, next.since_us);
  }
  examine(segments);
  return since_us;
}

std::size_t Detector::most_at_once() {
  return kManyOfCore * static_cast<std::size_t>(oneapi::tbb::this_task_arena::max_concurrency());
}

void Detector::rank_waiting(bool on_all_cores) {
  const std::vector<std::uint32_t> unranked = waiting_.unranked();
  const std::vector<float> distances = recognitions_.least_distances(unranked, on_all_cores);
  for (std::size_t i = 0; i < unranked.size(); ++i) {
    // What was told is examined once more when all else is known.
    const bool is_told = is_checking_all_ && told_of(unranked[i]) != detections_.end();
    waiting_.rank(unranked[i], is_told ? kAfterOthers : distances[i]);
  }
}

void Detector::examine(std::span<const std::uint32_t> segments) {
  const bool may_change = recognitions_.examine(segments);
  if (waiting_.empty()) settle_light();
  if (is_checking_all_) hurry_what_decides(segments);
  const bool is_light_open =
      is_checking_all_ && !is_light_settled_ && !is_light_expected_ && !waiting_.empty();
  if (is_light_open) return;
  if (may_change || is_checking_all_ || waiting_.empty()) update_detections();
  confirm_old_ones();
}

/// While the map grows: what was told of a segment, and is there still, is searched for again only
/// when twice as much of it is known: the surface of a thing comes in many parts.
bool Detector::follow(std::uint32_t segment) {
  const auto told = told_of(segment);
  if (told == detections_.end() || map().num_points(segment) == 0) return false;
  Recognition now = followed(told->recognition);
  if (!recognizer_->is_recognized(now.placement)) return false;
  if (now.placement.points >= kMuchMore * now.searched_points) return false;
  recognitions_.set(segment, std::move(now));
  update_detections();
  confirm_old_ones();
  return true;
}

/// The detection of which a segment is part.
std::vector<Detection>::const_iterator Detector::told_of(std::uint32_t segment) const {
  return std::ranges::find_if(detections_, [segment](const Detection& detection) {
    return is_active(detection) &&
           std::ranges::binary_search(detection.recognition.placement.segment_ids, segment);
  });
}

Recognition Detector::followed(const Recognition& last) const {
  Recognition now = last;
  now.placement = recognizer_->followed(last.model, last.placement, scene_);
  now.placement.light_agreement = recognitions_.light_of(now.model).agreement(now.placement.light);
  return now;
}

/// What was recognised there is told when nothing waits that may tell otherwise: its other
/// segments, those where the object was told before, and those of what was told there.
void Detector::hurry_what_decides(std::span<const std::uint32_t> examined) {
  for (const std::uint32_t segment : examined) {
    for (const Recognition& recognition : recognitions_.at(segment)) {
      for (const std::uint32_t id : recognition.placement.segment_ids) waiting_.hurry(id);
      for (const Detection& detection : detections_) {
        if (!is_active(detection) || !are_rivals(detection.recognition, recognition)) continue;
        for (const std::uint32_t id : segments_at(detection)) waiting_.hurry(id);
      }
    }
  }
}

void Detector::update_detections() {
  std::set<std::int32_t> kept;  // numbers of detections that hold
  const std::vector<Recognition> best = certain();
  std::vector<const Recognition*> others;
  for (const Recognition& recognition : best) {
    Detection* const detection = same_place(recognition, kept);
    if (detection == nullptr) {
      others.push_back(&recognition);
      continue;
    }
    if (!is_same(detection->recognition.placement, recognition.placement)) {
      detection->change_number = ++num_changes_;
    }
    detection->recognition = recognition;
    kept.insert(detection->number);
  }
  std::erase_if(others, [&](const Recognition* each) { return is_disputed(*each, kept); });
  for (Detection& detection : detections_) {
    // While all is examined once more, an object may be told elsewhere before it is gone here.
    if (is_checking_all_ || !is_active(detection) || kept.contains(detection.number)) continue;
    if (is_undecided(detection) || is_still_there(detection, best)) kept.insert(detection.number);
  }
  for (const Recognition* const recognition : others) {
    Detection* detection = vanished(*recognition, kept);
    const bool has_moved = detection != nullptr && !is_near(*detection, *recognition);
    if (detection == nullptr) {
      detection = &detections_.emplace_back();
      detection->number = static_cast<std::int32_t>(detections_.size());
    }
    detection->recognition = *recognition;
    detection->found_utime = utime_;
    kept.insert(detection->number);
    tell(*detection, has_moved ? DetectionEvent::kMoved : DetectionEvent::kFound);
  }
  for (Detection& detection : detections_) {
    if (!is_active(detection) || kept.contains(detection.number)) continue;
    if (!is_undecided(detection)) tell(detection, DetectionEvent::kGone);
  }
}

void Detector::confirm_old_ones() {
  for (Detection& detection : detections_) {
    if (detection.event != DetectionEvent::kFound || is_undecided(detection)) continue;
    // At rest, nothing more is known that could speak against it.
    const bool is_old = utime_ - detection.found_utime >= kConfirmed_us;
    if (is_old || waiting_.empty()) tell(detection, DetectionEvent::kConfirmed);
  }
}

/// The active detection of the same object that has surface in common with the recognition.
Detection* Detector::same_place(const Recognition& recognition,
                                const std::set<std::int32_t>& taken) {
  for (Detection& detection : detections_) {
    if (!is_active(detection) || taken.contains(detection.number)) continue;
    if (detection.recognition.model != recognition.model) continue;
    const bool is_same_place =
        is_near(detection, recognition) || share_segments(detection.recognition, recognition);
    if (is_same_place) return &detection;
  }
  return nullptr;
}

/// The nearest detection of this object that does not hold any more: the object may have been
/// moved.
Detection* Detector::vanished(const Recognition& recognition, const std::set<std::int32_t>& kept) {
  Detection* nearest = nullptr;
  for (Detection& detection : detections_) {
    if (detection.recognition.model != recognition.model || kept.contains(detection.number)) {
      continue;
    }
    const bool is_nearer = nearest == nullptr ||
                           distance_m(detection, recognition) < distance_m(*nearest, recognition);
    if (is_nearer) nearest = &detection;
  }
  return nearest;
}

double Detector::distance_m(const Detection& detection, const Recognition& recognition) const {
  return (detection.recognition.placement.X_WO.translation() -
          recognition.placement.X_WO.translation())
      .norm();
}

/// Its middle is still inside the object: other segments, perhaps, but the same place.
bool Detector::is_near(const Detection& detection, const Recognition& recognition) const {
  return distance_m(detection, recognition) < recognizer_->radius_m(recognition.model) / 2;
}

/// Where a detection may be found again: its segments, and all that lie there now.
std::set<std::uint32_t> Detector::segments_at(const Detection& detection) const {
  const auto& [model, placement, searched_points] = detection.recognition;
  std::set<std::uint32_t> segments = recognizer_->segments_around(model, placement, scene_);
  segments.insert(placement.segment_ids.begin(), placement.segment_ids.end());
  return segments;
}

bool Detector::may_be_found_again(const Detection& detection) const {
  return waiting_.contains_any(segments_at(detection));
}

bool Detector::is_waiting(const Recognition& recognition) const {
  return waiting_.contains_any(recognition.placement.segment_ids);
}

/// Some of its segments wait to be examined, or some of all that have to be.
bool Detector::is_undecided(const Detection& detection) const {
  if (is_checking_all_) return !waiting_.empty();
  return is_waiting(detection.recognition);
}

/// What is recognised and holds. While all is examined once more, only that of which nothing waits
/// that may tell otherwise.
std::vector<Recognition> Detector::certain() const {
  std::vector<Recognition> best = recognitions_.best();
  if (is_checking_all_) {
    std::erase_if(best, [this](const Recognition& each) { return is_waiting(each); });
  }
  return best;
}

/// While all is examined once more: whether something that was told and speaks against it may still
/// be found again, where it was: this object elsewhere, or something else of these segments.
bool Detector::is_disputed(const Recognition& recognition,
                           const std::set<std::int32_t>& kept) const {
  if (!is_checking_all_ || waiting_.empty()) return false;
  return std::ranges::any_of(detections_, [&](const Detection& detection) {
    if (!is_active(detection) || kept.contains(detection.number)) return false;
    return are_rivals(detection.recognition, recognition) && may_be_found_again(detection);
  });
}

/// While the map grows, segments are cut anew, and then an object is not always recognised in one
/// of them; it is not gone as long as the map shows it where it was, and nothing else there.
bool Detector::is_still_there(Detection& detection, const std::vector<Recognition>& best) {
  Recognition now = followed(detection.recognition);
  const bool is_replaced = std::ranges::any_of(
      best, [&now](const Recognition& other) { return share_segments(now, other); });
  if (!recognizer_->is_recognized(now.placement) || is_replaced) return false;
  recognitions_.add(now);
  detection.recognition = std::move(now);
  return true;
}

void Detector::tell(Detection& detection, DetectionEvent event) {
  detection.event = event;
  detection.event_number = ++num_events_;
  detection.change_number = ++num_changes_;
  detection.event_utime = utime_;
}

}  // namespace kintsugi::segmenter
