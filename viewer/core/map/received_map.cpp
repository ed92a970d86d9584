#include "viewer/core/map/received_map.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace kintsugi::viewer {

bool ReceivedMap::add_slice(CloudSlice message) {
  const auto held = slices_.find(message.id);
  if (held != slices_.end() && message.revision <= held->second.newest().revision()) {
    ++counts_.ignored_slices;
    return false;
  }
  if (message.kind == SliceKind::kFinal) note_final(message);
  if (message.kind == SliceKind::kCorrection) move_patches(message);
  const PatchPlace place = motions_.place_of(message);
  note_time(message.utime);
  revision_sum_ += message.revision;
  if (held == slices_.end()) {
    ++counts_.slices;
    const std::int32_t id = message.id;
    SliceRevisions& added =
        slices_.try_emplace(id, MapSlice(std::move(message), place)).first->second;
    apply_pending(added.newest());
    note_shown(added.shown());
    return true;
  }
  SliceRevisions& slice = held->second;
  revision_sum_ -= slice.newest().revision();
  if (slice.newest().is_labelled()) --counts_.labelled_slices;
  slice.add(MapSlice(std::move(message), place));
  apply_pending(slice.newest());
  advance(slice);
  return true;
}

void ReceivedMap::move_patches(const CloudSlice& correction) {
  for (const auto& [id, place] : motions_.learn(correction)) {
    const auto found = slices_.find(id);
    if (found == slices_.end()) continue;
    note_hidden(found->second.shown());
    found->second.for_each([&place = place](MapSlice& slice) { slice.move_to(place); });
    note_shown(found->second.shown());
  }
  note_loops(correction);
}

/// The newest correction of a part has all its loops.
void ReceivedMap::note_loops(const CloudSlice& correction) {
  Part& part = parts_[correction.part];
  if (correction.correction <= part.loops_correction) return;
  part.loops_correction = correction.correction;
  part.loops = correction.loops;
}

std::vector<LoopLink> ReceivedMap::loops(std::int32_t part) const {
  const auto found = parts_.find(part);
  return found == parts_.end() ? std::vector<LoopLink>() : found->second.loops;
}

void ReceivedMap::note_final(const CloudSlice& slice) {
  final_slice_ = {slice.id, slice.revision_sum};
}

/// Shows another revision of the slice, if one is to be shown now.
void ReceivedMap::advance(SliceRevisions& slice) {
  if (const auto replaced = slice.advance()) {
    note_hidden(*replaced);
    note_shown(slice.shown());
  }
}

void ReceivedMap::note_shown(const MapSlice& slice) {
  const auto num_points = static_cast<std::int64_t>(slice.points_W().size());
  counts_.points += num_points;
  Part& part = parts_[slice.part()];
  part.points.shown += num_points;
  if (slice.in_volume()) part.points.in_volume += num_points;
  part.up.add(slice.points_W());
}

void ReceivedMap::note_hidden(const MapSlice& slice) {
  const auto num_points = static_cast<std::int64_t>(slice.points_W().size());
  counts_.points -= num_points;
  Part& part = parts_.at(slice.part());
  part.points.shown -= num_points;
  if (slice.in_volume()) part.points.in_volume -= num_points;
  part.up.remove(slice.points_W());
}

bool ReceivedMap::accept_segmenter(std::int64_t session) {
  if (session > segmenter_session_) {
    if (segmenter_session_ != 0) await_new_segmenter();
    segmenter_session_ = session;
  }
  return session == segmenter_session_;
}

void ReceivedMap::await_new_segmenter() {
  for (auto& [id, slice] : slices_)
    slice.for_each([](MapSlice& held) { held.await_new_segmenter(); });
  counts_.labelled_slices = 0;
  pending_.clear();
  newest_update_.reset();
  announced_slices_ = 0;
  final_update_seen_ = false;
}

void ReceivedMap::settle() {
  for (auto& [id, slice] : slices_) {
    if (const auto replaced = slice.advance_to_newest()) {
      note_hidden(*replaced);
      note_shown(slice.shown());
    }
    slice.newest().discard_old_labels();
  }
}

/// A newer revision than this one is here.
bool ReceivedMap::is_replaced(SliceKey key) const {
  const auto found = slices_.find(key.id);
  return found != slices_.end() && found->second.newest().revision() > key.revision;
}

/// nullptr: not here.
MapSlice* ReceivedMap::find(SliceKey key) {
  const auto found = slices_.find(key.id);
  return found == slices_.end() ? nullptr : found->second.find(key.revision);
}

bool ReceivedMap::apply_update(const SegmentUpdate& update) {
  const bool is_numbered = update.sequence >= 0 && update.sequence < UINT32_MAX;
  if (update.map_session != map_session_ || !is_numbered || !accept_segmenter(update.session)) {
    ++counts_.ignored_updates;
    return false;
  }
  const auto number = static_cast<std::uint32_t>(update.sequence);
  const UpdateEffect effect =
      use_labels({update.slice_id, update.slice_revision}, {update.labels, number});
  bool changed = effect == UpdateEffect::kChanged;
  changed |= use_counts(update, number);
  for (const LabelRun& run : update.runs) changed |= use_run({run, number});
  if (effect == UpdateEffect::kNotUsable) {
    ++counts_.ignored_updates;
  } else {
    ++(changed ? counts_.updates : counts_.repeated_updates);
  }
  return changed;
}

/// True when they say something new about the map.
bool ReceivedMap::use_counts(const SegmentUpdate& update, std::uint32_t number) {
  const auto before = std::tuple(counts_.segments, announced_slices_, final_update_seen_);
  if (!newest_update_ || number >= *newest_update_) {
    newest_update_ = number;
    counts_.segments = update.num_segments;
  }
  // The updates of a full state count slices from 1 again: the maximum holds.
  announced_slices_ = std::max<std::int64_t>(announced_slices_, update.num_slices);
  final_update_seen_ = final_update_seen_ || update.is_final;
  return before != std::tuple(counts_.segments, announced_slices_, final_update_seen_);
}

UpdateEffect ReceivedMap::use_labels(SliceKey key, NumberedLabels labels) {
  if (MapSlice* const slice = find(key)) {
    const UpdateEffect effect = apply_labels(*slice, labels);
    advance(slices_.at(key.id));
    return effect;
  }
  if (is_replaced(key)) return UpdateEffect::kNotUsable;
  return pending_.add(key, std::move(labels));
}

/// True when it changed something, or will when its slice arrives.
bool ReceivedMap::use_run(const NumberedRun& run) {
  const SliceKey key{run.run.slice_id, run.run.slice_revision};
  if (MapSlice* const slice = find(key)) return apply_run(*slice, run);
  if (is_replaced(key)) return false;
  const bool is_kept = pending_.add(run);
  if (!is_kept) ++counts_.ignored_runs;
  return is_kept;
}

/// Applies what waited for this revision, and drops what waited for earlier ones.
void ReceivedMap::apply_pending(MapSlice& slice) {
  const auto apply = [&](SliceKey key, const PendingUpdates::Entry& pending) {
    UpdateEffect effect = UpdateEffect::kNotUsable;
    if (key.revision == slice.revision()) {
      for (const NumberedRun& run : pending.runs) apply_run(slice, run);
      if (pending.labels) effect = apply_labels(slice, *pending.labels);
    }
    if (pending.labels && effect == UpdateEffect::kNotUsable) {
      --counts_.updates;  // it was counted as usable when it arrived
      ++counts_.ignored_updates;
    }
  };
  pending_.take_up_to({slice.id(), slice.revision()}, apply);
}

UpdateEffect ReceivedMap::apply_labels(MapSlice& slice, const NumberedLabels& labels) {
  const bool is_first = !slice.is_labelled();
  const bool is_first_of_any_segmenter = !slice.was_labelled();
  const UpdateEffect effect = slice.apply(labels);
  if (effect == UpdateEffect::kNotUsable) return effect;
  const bool is_newest = slice.revision() == slices_.at(slice.id()).newest().revision();
  if (is_first && is_newest) ++counts_.labelled_slices;
  if (is_first_of_any_segmenter) ++counts_.labellings;
  return effect;
}

/// True when it changed something.
bool ReceivedMap::apply_run(MapSlice& slice, const NumberedRun& run) {
  const UpdateEffect effect = slice.apply(run);
  if (effect == UpdateEffect::kNotUsable) ++counts_.ignored_runs;
  return effect == UpdateEffect::kChanged;
}

bool ReceivedMap::add_pose(const CameraPose& pose) {
  if (!poses_[pose.part].add(pose)) return false;
  note_time(pose.utime);
  return true;
}

CameraTrack ReceivedMap::received_track(std::int32_t part) const {
  const auto found = poses_.find(part);
  if (found == poses_.end()) return slice_track(part);
  CameraTrack track = found->second.track(slice_poses(part));
  track.loops = loops(part);
  return track;
}

CameraTrack ReceivedMap::slice_track(std::int32_t part) const {
  CameraTrack track = track_through(slice_poses(part));
  track.loops = loops(part);
  return track;
}

std::vector<TimedPose> ReceivedMap::slice_poses(std::int32_t part) const {
  std::vector<TimedPose> poses;
  poses.reserve(slices_.size());
  for (const auto& [id, slice] : slices_) {
    if (slice.newest().part_of_camera() != part) continue;
    poses.push_back({slice.newest().utime(), slice.newest().X_WC()});
  }
  std::ranges::stable_sort(poses, {}, &TimedPose::utime);
  const auto repeated = std::ranges::unique(poses, {}, &TimedPose::utime);  // those of one batch
  poses.erase(repeated.begin(), repeated.end());
  return poses;
}

void ReceivedMap::note_time(std::int64_t utime) {
  utime_ = std::max(utime_.value_or(utime), utime);
  first_utime_ = std::min(first_utime_.value_or(utime), utime);
}

std::int64_t ReceivedMap::lag_slices() const {
  std::int64_t known = std::max(counts_.slices, announced_slices_);
  std::int64_t outdated = 0;
  if (final_slice_) {
    known = std::max(known, std::int64_t{final_slice_->id} + 1);
    if (revision_sum_ < final_slice_->revision_sum) outdated = 1;  // at least
  }
  // The segmenter may have labelled a newer revision of a labelled slice.
  const auto is_labelled = [this](std::int32_t id) {
    const auto found = slices_.find(id);
    return found != slices_.end() && found->second.newest().is_labelled();
  };
  const std::int64_t named = pending_.count_labelled_if(is_labelled);
  return known - counts_.labelled_slices + std::max(named, outdated);
}

const MapSlice* ReceivedMap::slice(std::int32_t id) const {
  const auto found = slices_.find(id);
  return found == slices_.end() ? nullptr : &found->second.shown();
}

std::set<std::int32_t> ReceivedMap::parts() const {
  std::set<std::int32_t> parts;
  for (const auto& [number, part] : parts_) {
    if (part.points.shown > 0) parts.insert(number);
  }
  return parts;
}

std::int32_t ReceivedMap::camera_part() const {
  const auto newest = std::ranges::max_element(
      poses_, {}, [](const auto& of_part) { return of_part.second.newest_utime(); });
  if (newest != poses_.end() && has_points(newest->first)) return newest->first;
  return newest_part();
}

std::int32_t ReceivedMap::newest_part() const {
  std::int32_t part = 0;
  std::optional<std::int64_t> newest_utime;
  for (const auto& [id, slice] : slices_) {
    const MapSlice& shown = slice.shown();
    if (shown.points_W().empty() || shown.utime() < newest_utime) continue;
    newest_utime = shown.utime();
    part = shown.part();
  }
  return part;
}

std::vector<PointChunk> ReceivedMap::chunks(std::int32_t part) const {
  std::vector<PointChunk> chunks;
  for (const auto& [id, slice] : slices_) {
    if (slice.shown().part() == part) slice.shown().append_chunks(chunks);
  }
  return chunks;
}

PointCounts ReceivedMap::points(std::int32_t part) const {
  const auto found = parts_.find(part);
  return found == parts_.end() ? PointCounts{} : found->second.points;
}

const UpDirection& ReceivedMap::up(std::int32_t part) const {
  static const UpDirection kOfNothing;
  const auto found = parts_.find(part);
  return found == parts_.end() ? kOfNothing : found->second.up;
}

}  // namespace kintsugi::viewer
