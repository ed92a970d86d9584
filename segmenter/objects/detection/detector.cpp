#include "segmenter/objects/detection/detector.hpp"

#include <algorithm>
#include <utility>

namespace kintsugi::segmenter {

namespace {

// A detection that still holds so long after it was found is confirmed. The camera, at walking
// pace, has seen the rest of an object by then.
constexpr std::int64_t kConfirmed_us = 1'000'000;

// Of logarithms: 10 %, less than things of one place differ.
constexpr float kSameLight = 0.1F;

bool is_active(const Detection& detection) { return detection.event != DetectionEvent::kGone; }

bool share_segments(const Recognition& a, const Recognition& b) {
  const std::vector<std::uint32_t>& ids = b.placement.segment_ids;
  return std::any_of(
      a.placement.segment_ids.begin(), a.placement.segment_ids.end(),
      [&ids](std::uint32_t id) { return std::binary_search(ids.begin(), ids.end(), id); });
}

bool is_same(const Placement& a, const Placement& b) {
  return a.X_WO.matrix() == b.X_WO.matrix() && a.segment_ids == b.segment_ids;
}

}  // namespace

Detector::Detector(std::vector<ObjectModel> models, float resolution_m)
    : recognizer_(std::move(models), resolution_m),
      scene_(resolution_m),
      observed_(resolution_m),
      recognitions_(recognizer_, scene_) {}

void Detector::set_piece(std::int32_t id, LabelledMap::Points points_W,
                         std::vector<std::uint32_t> segment_ids, std::int64_t utime) {
  utime_ = std::max(utime_, utime);
  const std::set<std::uint32_t> changed =
      scene_.set_piece(id, std::move(points_W), std::move(segment_ids));
  changed_.insert(changed.begin(), changed.end());
  std::set<std::uint32_t> changed_much;
  for (const std::uint32_t segment : changed) {
    if (waiting_.has_changed_much(segment, map().num_points(segment))) changed_much.insert(segment);
    wait_for(segment);
  }
  // What was recognised depends on all of its segments.
  for (const std::uint32_t seed : recognitions_.seeds_of(changed_much)) wait_for(seed, true);
  for (const std::uint32_t seed : recognitions_.seeds_of(changed)) wait_for(seed);
}

void Detector::set_views(std::span<const MapView> views) {
  observed_.clear();
  for (const MapView& view : views) observed_.add(view);
  scene_.set_observed(observed_.empty() ? nullptr : &observed_);
}

void Detector::examine_all() {
  is_light_settled_ = false;
  begin_again({});
}

/// Where something was recognised comes first: it is there still, most often.
void Detector::begin_again(const LightChange& light) {
  const std::set<std::uint32_t> seeds = recognitions_.seeds();
  scene_.set_light(light);
  recognitions_.forget_all();
  waiting_.clear();
  for (const std::uint32_t seed : seeds) wait_for(seed, true);
  for (const std::uint32_t segment : map().segments()) {
    changed_.insert(segment);
    wait_for(segment);
  }
}

/// When the light of the map becomes known and is another one, all is examined in it once more.
void Detector::settle_light() {
  if (is_light_settled_) return;
  const std::optional<LightChange> change = recognitions_.light();
  if (!change) return;
  is_light_settled_ = true;
  if (change->log_gain.cwiseAbs().maxCoeff() < kSameLight) return;
  LightChange light;
  light.log_gain = scene_.light().log_gain + change->log_gain;
  begin_again(light);
}

void Detector::wait_for(std::uint32_t segment, bool is_urgent) {
  waiting_.add(segment, map().num_points(segment), utime_, is_urgent);
}

void Detector::examine_next() {
  if (waiting_.empty()) return;
  if (!changed_.empty()) {
    recognitions_.forget(changed_);
    changed_.clear();
  }
  const std::uint32_t segment = waiting_.pop();
  const bool may_change = recognitions_.examine(segment);
  if (waiting_.empty()) settle_light();
  if (may_change) update_detections();
  confirm_old_ones();
}

void Detector::update_detections() {
  std::set<std::int32_t> kept;  // numbers of detections that hold
  std::vector<Recognition> others;
  for (Recognition& recognition : recognitions_.best()) {
    Detection* const detection = same_place(recognition, kept);
    if (detection == nullptr) {
      others.push_back(std::move(recognition));
      continue;
    }
    if (!is_same(detection->recognition.placement, recognition.placement)) {
      detection->change_number = ++num_changes_;
    }
    detection->recognition = std::move(recognition);
    kept.insert(detection->number);
  }
  for (Recognition& recognition : others) {
    Detection* detection = vanished(recognition.model, kept);
    const bool has_moved = detection != nullptr;
    if (!has_moved) {
      detection = &detections_.emplace_back();
      detection->number = static_cast<std::int32_t>(detections_.size());
    }
    detection->recognition = std::move(recognition);
    detection->found_utime = utime_;
    kept.insert(detection->number);
    tell(*detection, has_moved ? DetectionEvent::kMoved : DetectionEvent::kFound);
  }
  for (Detection& detection : detections_) {
    if (!is_active(detection) || kept.contains(detection.number) || is_undecided(detection)) {
      continue;
    }
    tell(detection, DetectionEvent::kGone);
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
    const double apart_m = (detection.recognition.placement.X_WO.translation() -
                            recognition.placement.X_WO.translation())
                               .norm();
    // Its middle is still inside the object: other segments, but the same place.
    const bool is_near = apart_m < recognizer_.radius_m(recognition.model) / 2;
    if (is_near || share_segments(detection.recognition, recognition)) return &detection;
  }
  return nullptr;
}

/// A detection of this object that does not hold any more: the object may have been moved.
Detection* Detector::vanished(std::size_t model, const std::set<std::int32_t>& kept) {
  for (Detection& detection : detections_) {
    if (detection.recognition.model != model || kept.contains(detection.number)) continue;
    if (is_active(detection) && is_undecided(detection)) continue;
    return &detection;
  }
  return nullptr;
}

/// Some of its segments wait to be examined.
bool Detector::is_undecided(const Detection& detection) const {
  const std::vector<std::uint32_t>& ids = detection.recognition.placement.segment_ids;
  return std::any_of(ids.begin(), ids.end(),
                     [this](std::uint32_t id) { return waiting_.contains(id); });
}

void Detector::tell(Detection& detection, DetectionEvent event) {
  detection.event = event;
  detection.event_number = ++num_events_;
  detection.change_number = ++num_changes_;
  detection.event_utime = utime_;
}

}  // namespace kintsugi::segmenter
