#include "viewer/core/scene/scene.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace kintsugi::viewer {
namespace {

/// Boxes of each kChunkPoints consecutive points; those that are not finite are left out.
std::vector<Eigen::AlignedBox3f> chunk_boxes(std::span<const CloudPoint> points_W) {
  std::vector<Eigen::AlignedBox3f> boxes;
  for (std::size_t first = 0; first < points_W.size(); first += Scene::kChunkPoints) {
    Eigen::AlignedBox3f box;
    const std::size_t count = std::min(Scene::kChunkPoints, points_W.size() - first);
    for (const CloudPoint& p : points_W.subspan(first, count)) {
      const Eigen::Vector3f p_W(p.x, p.y, p.z);
      if (p_W.allFinite()) box.extend(p_W);
    }
    boxes.push_back(box);
  }
  return boxes;
}

void append_chunks(const SceneSlice& slice, std::vector<PointChunk>& chunks) {
  const std::span points_W(slice.points_W);
  const std::span labels(slice.labels);
  for (std::size_t i = 0; i < slice.chunk_boxes.size(); ++i) {
    const std::size_t first = i * Scene::kChunkPoints;
    const std::size_t count = std::min(Scene::kChunkPoints, points_W.size() - first);
    chunks.push_back({points_W.subspan(first, count), labels.subspan(first, count),
                      slice.chunk_boxes[i], slice.resolution_m});
  }
}

}  // namespace

bool Scene::add_slice(CloudSlice message) {
  SceneSlice* slice = nullptr;
  if (const auto found = slices_.find(message.id); found != slices_.end()) {
    slice = &found->second;
    if (message.revision <= slice->revision) {
      ++counts_.ignored_slices;
      return false;
    }
    counts_.points -= static_cast<std::int64_t>(slice->points_W.size());
    up_.remove(slice->points_W);
    if (slice->labelled) --counts_.labelled_slices;
  } else {
    slice = &slices_[message.id];
    ++counts_.slices;
  }

  *slice = SceneSlice();
  slice->utime = message.utime;
  slice->id = message.id;
  slice->revision = message.revision;
  slice->resolution_m = message.resolution_m;
  slice->X_WC = message.X_WC;
  slice->points_W = std::move(message.points_W);
  slice->labels.assign(slice->points_W.size(), kNoSegment);
  slice->label_updates.assign(slice->points_W.size(), 0);
  slice->chunk_boxes = chunk_boxes(slice->points_W);

  counts_.points += static_cast<std::int64_t>(slice->points_W.size());
  advance_time(slice->utime);
  up_.add(slice->points_W);
  apply_pending(*slice);
  return true;
}

bool Scene::accept_segmenter(std::int64_t session) {
  if (session > segmenter_session_) {
    if (segmenter_session_ != 0) expect_labels_anew();
    segmenter_session_ = session;
  }
  return session == segmenter_session_;
}

/// The labels stay to be looked at; any update takes their place.
void Scene::expect_labels_anew() {
  for (auto& [id, slice] : slices_) {
    std::ranges::fill(slice.label_updates, 0U);
    slice.labelled = false;
  }
  counts_.labelled_slices = 0;
  pending_.clear();
  newest_update_.reset();
  announced_slices_ = 0;
  final_update_seen_ = false;
}

void Scene::discard_old_labels() {
  for (auto& [id, slice] : slices_) {
    if (slice.labelled || !slice.was_labelled) continue;
    for (std::size_t i = 0; i < slice.labels.size(); ++i) {
      if (slice.label_updates[i] == 0) slice.labels[i] = kNoSegment;
    }
    slice.was_labelled = false;
  }
}

Scene::Presence Scene::presence(SliceKey key) const {
  const auto found = slices_.find(key.id);
  if (found == slices_.end() || found->second.revision < key.revision) return Presence::kNotYet;
  return found->second.revision == key.revision ? Presence::kHere : Presence::kReplaced;
}

bool Scene::apply_update(const SegmentUpdate& update) {
  const bool is_numbered = update.sequence >= 0 && update.sequence < UINT32_MAX;
  if (update.map_session != map_session_ || !is_numbered || !accept_segmenter(update.session)) {
    ++counts_.ignored_updates;
    return false;
  }
  const auto number = static_cast<std::uint32_t>(update.sequence);
  const Effect effect =
      use_labels({update.slice_id, update.slice_revision}, {update.labels, number});
  bool changed = effect == Effect::kNews;
  changed |= use_counts(update, number);
  for (const LabelRun& run : update.runs) changed |= use_run({run, number});
  if (effect == Effect::kIgnored) {
    ++counts_.ignored_updates;
  } else {
    ++(changed ? counts_.updates : counts_.repeated_updates);
  }
  return changed;
}

/// True when they say something new about the map.
bool Scene::use_counts(const SegmentUpdate& update, std::uint32_t number) {
  const auto before = std::tuple(counts_.segments, announced_slices_, final_update_seen_);
  if (!newest_update_ || number >= *newest_update_) {
    newest_update_ = number;
    counts_.segments = update.num_segments;
  }
  // A description of the whole map counts up to it again.
  announced_slices_ = std::max<std::int64_t>(announced_slices_, update.num_slices);
  final_update_seen_ = final_update_seen_ || update.is_final;
  return before != std::tuple(counts_.segments, announced_slices_, final_update_seen_);
}

Scene::Effect Scene::use_labels(SliceKey key, PendingUpdates::Labels labels) {
  switch (presence(key)) {
    case Presence::kHere:
      return apply_labels(slices_.at(key.id), labels);
    case Presence::kReplaced:
      return Effect::kIgnored;
    case Presence::kNotYet:
      break;
  }
  switch (pending_.add(key, std::move(labels))) {
    case PendingUpdates::Outcome::kNews:
      return Effect::kNews;
    case PendingUpdates::Outcome::kKnown:
      return Effect::kNothingNew;
    case PendingUpdates::Outcome::kNoRoom:
      break;
  }
  return Effect::kIgnored;
}

bool Scene::use_run(const PendingUpdates::Run& run) {
  const SliceKey key{run.run.slice_id, run.run.slice_revision};
  switch (presence(key)) {
    case Presence::kHere:
      return apply_run(slices_.at(key.id), run);
    case Presence::kReplaced:
      return false;
    case Presence::kNotYet:
      break;
  }
  const bool is_kept = pending_.add(run);
  if (!is_kept) ++counts_.ignored_runs;
  return is_kept;
}

/// Applies what waited for this revision; what waited for earlier ones means nothing any more.
void Scene::apply_pending(SceneSlice& slice) {
  const auto apply = [&](SliceKey key, const PendingUpdates::Entry& pending) {
    Effect effect = Effect::kIgnored;
    if (key.revision == slice.revision) {
      for (const PendingUpdates::Run& run : pending.runs) apply_run(slice, run);
      if (pending.labels) effect = apply_labels(slice, *pending.labels);
    }
    if (pending.labels && effect == Effect::kIgnored) {
      --counts_.updates;  // counted when it came
      ++counts_.ignored_updates;
    }
  };
  pending_.take_up_to({slice.id, slice.revision}, apply);
}

Scene::Effect Scene::apply_labels(SceneSlice& slice, const PendingUpdates::Labels& update) {
  if (update.labels.size() != slice.labels.size()) return Effect::kIgnored;
  bool changed = !slice.labelled;
  for (std::size_t i = 0; i < slice.labels.size(); ++i) {
    if (slice.label_updates[i] > update.number + 1) continue;
    changed |= slice.labels[i] != update.labels[i];
    slice.labels[i] = update.labels[i];
    slice.label_updates[i] = update.number + 1;
  }
  if (!slice.labelled) ++counts_.labelled_slices;
  if (!slice.was_labelled) ++counts_.labellings;
  slice.labelled = true;
  slice.was_labelled = true;
  return changed ? Effect::kNews : Effect::kNothingNew;
}

bool Scene::apply_run(SceneSlice& slice, const PendingUpdates::Run& update) {
  const LabelRun& run = update.run;
  const auto size = static_cast<std::int64_t>(slice.labels.size());
  if (run.first < 0 || run.count <= 0 || std::int64_t{run.first} + run.count > size) {
    ++counts_.ignored_runs;
    return false;
  }
  bool changed = false;
  const auto first = static_cast<std::size_t>(run.first);
  for (std::size_t i = first; i < first + static_cast<std::size_t>(run.count); ++i) {
    if (slice.label_updates[i] > update.number + 1) continue;
    changed |= slice.labels[i] != run.segment_id;
    slice.labels[i] = run.segment_id;
    slice.label_updates[i] = update.number + 1;
  }
  return changed;
}

bool Scene::add_pose(const CameraPose& pose) {
  if (!poses_.add(pose)) return false;
  advance_time(pose.utime);
  return true;
}

std::vector<TimedPose> Scene::slice_poses() const {
  std::vector<TimedPose> poses;
  poses.reserve(slices_.size());
  for (const auto& [id, slice] : slices_) poses.push_back({slice.utime, slice.X_WC});
  std::ranges::stable_sort(poses, {}, &TimedPose::utime);
  return poses;
}

void Scene::advance_time(std::int64_t utime) {
  utime_ = std::max(utime_.value_or(utime), utime);
  first_utime_ = std::min(first_utime_.value_or(utime), utime);
}

std::int64_t Scene::lag_slices() const {
  const std::int64_t known = std::max(counts_.slices, announced_slices_);
  // Of a labelled slice the segmenter may know a newer revision.
  const auto is_labelled = [this](std::int32_t id) {
    const SceneSlice* const here = slice(id);
    return here != nullptr && here->labelled;
  };
  return known - counts_.labelled_slices + pending_.count_labelled_if(is_labelled);
}

const SceneSlice* Scene::slice(std::int32_t id) const {
  const auto found = slices_.find(id);
  return found == slices_.end() ? nullptr : &found->second;
}

const SceneSlice* Scene::newest_slice() const {
  const SceneSlice* newest = nullptr;
  for (auto it = slices_.rbegin(); it != slices_.rend(); ++it) {
    const SceneSlice& slice = it->second;
    if (slice.points_W.empty()) continue;
    if (slice.was_labelled) return &slice;
    if (newest == nullptr) newest = &slice;
  }
  return newest;
}

std::vector<PointChunk> Scene::chunks() const {
  std::vector<PointChunk> chunks;
  for (const auto& [id, slice] : slices_) append_chunks(slice, chunks);
  return chunks;
}

std::vector<PointChunk> Scene::chunks(const SceneSlice& slice) const {
  std::vector<PointChunk> chunks;
  append_chunks(slice, chunks);
  return chunks;
}

Eigen::AlignedBox3f Scene::box_W() const {
  Eigen::AlignedBox3f box;
  for (const auto& [id, slice] : slices_) {
    for (const Eigen::AlignedBox3f& chunk_box : slice.chunk_boxes) box.extend(chunk_box);
  }
  return box;
}

std::int64_t Scene::memory_bytes() const {
  constexpr std::int64_t kBytesPerPoint = sizeof(CloudPoint) + 2 * sizeof(std::uint32_t);
  return counts_.points * kBytesPerPoint + static_cast<std::int64_t>(pending_.bytes()) +
         poses_.memory_bytes();
}

}  // namespace kintsugi::viewer
