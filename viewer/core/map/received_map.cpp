#include "viewer/core/map/received_map.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace kintsugi::viewer {

bool ReceivedMap::add_slice(CloudSlice message) {
  if (const MapSlice* const held = slice(message.id)) {
    if (message.revision <= held->revision()) {
      ++counts_.ignored_slices;
      return false;
    }
    counts_.points -= static_cast<std::int64_t>(held->points_W().size());
    up_.remove(held->points_W());
    if (held->is_labelled()) --counts_.labelled_slices;
  } else {
    ++counts_.slices;
  }
  const std::int32_t id = message.id;
  MapSlice& added = slices_.insert_or_assign(id, MapSlice(std::move(message))).first->second;
  counts_.points += static_cast<std::int64_t>(added.points_W().size());
  advance_time(added.utime());
  up_.add(added.points_W());
  apply_pending(added);
  return true;
}

bool ReceivedMap::accept_segmenter(std::int64_t session) {
  if (session > segmenter_session_) {
    if (segmenter_session_ != 0) await_new_segmenter();
    segmenter_session_ = session;
  }
  return session == segmenter_session_;
}

void ReceivedMap::await_new_segmenter() {
  for (auto& [id, slice] : slices_) slice.await_new_segmenter();
  counts_.labelled_slices = 0;
  pending_.clear();
  newest_update_.reset();
  announced_slices_ = 0;
  final_update_seen_ = false;
}

void ReceivedMap::discard_old_labels() {
  for (auto& [id, slice] : slices_) slice.discard_old_labels();
}

ReceivedMap::Presence ReceivedMap::presence(SliceKey key) const {
  const MapSlice* const held = slice(key.id);
  if (held == nullptr || held->revision() < key.revision) return Presence::kNotYet;
  return held->revision() == key.revision ? Presence::kHere : Presence::kReplaced;
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
  const Presence slice = presence(key);
  if (slice == Presence::kNotYet) return pending_.add(key, std::move(labels));
  if (slice == Presence::kReplaced) return UpdateEffect::kNotUsable;
  return apply_labels(slices_.at(key.id), labels);
}

/// True when it changed something, or will when its slice arrives.
bool ReceivedMap::use_run(const NumberedRun& run) {
  const SliceKey key{run.run.slice_id, run.run.slice_revision};
  const Presence slice = presence(key);
  if (slice == Presence::kHere) return apply_run(slices_.at(key.id), run);
  if (slice == Presence::kReplaced) return false;
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
  if (is_first) ++counts_.labelled_slices;
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
  if (!poses_.add(pose)) return false;
  advance_time(pose.utime);
  return true;
}

std::vector<TimedPose> ReceivedMap::slice_poses() const {
  std::vector<TimedPose> poses;
  poses.reserve(slices_.size());
  for (const auto& [id, slice] : slices_) poses.push_back({slice.utime(), slice.X_WC()});
  std::ranges::stable_sort(poses, {}, &TimedPose::utime);
  return poses;
}

void ReceivedMap::advance_time(std::int64_t utime) {
  utime_ = std::max(utime_.value_or(utime), utime);
  first_utime_ = std::min(first_utime_.value_or(utime), utime);
}

std::int64_t ReceivedMap::lag_slices() const {
  const std::int64_t known = std::max(counts_.slices, announced_slices_);
  // The segmenter may have labelled a newer revision of a labelled slice.
  const auto is_labelled = [this](std::int32_t id) {
    const MapSlice* const held = slice(id);
    return held != nullptr && held->is_labelled();
  };
  return known - counts_.labelled_slices + pending_.count_labelled_if(is_labelled);
}

const MapSlice* ReceivedMap::slice(std::int32_t id) const {
  const auto found = slices_.find(id);
  return found == slices_.end() ? nullptr : &found->second;
}

const MapSlice* ReceivedMap::newest_slice() const {
  const MapSlice* newest = nullptr;
  for (auto it = slices_.rbegin(); it != slices_.rend(); ++it) {
    const MapSlice& slice = it->second;
    if (slice.points_W().empty()) continue;
    if (slice.was_labelled()) return &slice;
    if (newest == nullptr) newest = &slice;
  }
  return newest;
}

std::vector<PointChunk> ReceivedMap::chunks() const {
  std::vector<PointChunk> chunks;
  for (const auto& [id, slice] : slices_) slice.append_chunks(chunks);
  return chunks;
}

}  // namespace kintsugi::viewer
