#include "viewer/core/scene.hpp"

#include <algorithm>
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

void Scene::add_slice(CloudSlice message) {
  SceneSlice* slice = nullptr;
  if (const auto found = slices_.find(message.id); found != slices_.end()) {
    slice = &found->second;
    if (message.revision <= slice->revision) {
      ++counts_.ignored_slices;
      return;
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
}

bool Scene::accept_segmenter(std::int64_t session) {
  if (session == segmenter_session_) return true;
  if (std::ranges::count(superseded_segmenters_, session) > 0) return false;
  if (segmenter_session_ != 0) {
    superseded_segmenters_.push_back(segmenter_session_);
    discard_labels();
  }
  segmenter_session_ = session;
  return true;
}

void Scene::discard_labels() {
  for (auto& [id, slice] : slices_) {
    std::ranges::fill(slice.labels, kNoSegment);
    std::ranges::fill(slice.label_updates, 0U);
    slice.labelled = false;
  }
  counts_.labelled_slices = 0;
  counts_.segments = 0;
  pending_.clear();
  pending_runs_ = 0;
  newest_update_.reset();
  newest_labelled_id_ = -1;
  announced_slices_ = 0;
  final_update_seen_ = false;
}

Scene::Presence Scene::presence(SliceKey key) const {
  const auto found = slices_.find(key.id);
  if (found == slices_.end() || found->second.revision < key.revision) return Presence::kNotYet;
  return found->second.revision == key.revision ? Presence::kHere : Presence::kReplaced;
}

void Scene::apply_update(const SegmentUpdate& update) {
  const bool is_numbered = update.sequence >= 0 && update.sequence < UINT32_MAX;
  if (update.map_session != map_session_ || !is_numbered || !accept_segmenter(update.session)) {
    ++counts_.ignored_updates;
    return;
  }
  ++counts_.updates;
  const auto number = static_cast<std::uint32_t>(update.sequence);
  if (!newest_update_ || number >= *newest_update_) {
    newest_update_ = number;
    counts_.segments = update.num_segments;
    announced_slices_ = update.num_slices;
  }
  final_update_seen_ = final_update_seen_ || update.is_final;
  use_labels({update.slice_id, update.slice_revision}, {update.labels, number});
  for (const LabelRun& run : update.runs) use_run({run, number});
}

void Scene::use_labels(SliceKey key, PendingLabels labels) {
  switch (presence(key)) {
    case Presence::kHere:
      apply_labels(slices_.at(key.id), labels);
      break;
    case Presence::kReplaced:
      ignore_counted_update();
      break;
    case Presence::kNotYet:
      auto& waiting = pending_[key].labels;
      if (!waiting || waiting->number <= labels.number) waiting = std::move(labels);
      break;
  }
}

void Scene::use_run(const PendingRun& pending) {
  const SliceKey key{pending.run.slice_id, pending.run.slice_revision};
  switch (presence(key)) {
    case Presence::kHere:
      apply_run(slices_.at(key.id), pending);
      break;
    case Presence::kReplaced:
      break;
    case Presence::kNotYet:
      if (pending_runs_ < kMaxPendingRuns) {
        pending_[key].runs.push_back(pending);
        ++pending_runs_;
      } else {
        ++counts_.ignored_runs;
      }
      break;
  }
}

/// Applies what waited for this revision; what waited for earlier ones means nothing any more.
void Scene::apply_pending(SceneSlice& slice) {
  const auto end = pending_.upper_bound({slice.id, slice.revision});
  for (auto it = pending_.lower_bound({slice.id, 0}); it != end; it = pending_.erase(it)) {
    const auto& [key, pending] = *it;
    pending_runs_ -= pending.runs.size();
    if (key.revision < slice.revision) {
      if (pending.labels) ignore_counted_update();
      continue;
    }
    for (const PendingRun& run : pending.runs) apply_run(slice, run);
    if (pending.labels) apply_labels(slice, *pending.labels);
  }
}

void Scene::ignore_counted_update() {
  ++counts_.ignored_updates;
  --counts_.updates;
}

void Scene::apply_labels(SceneSlice& slice, const PendingLabels& pending) {
  if (pending.labels.size() != slice.labels.size()) {
    ignore_counted_update();
    return;
  }
  for (std::size_t i = 0; i < slice.labels.size(); ++i) {
    if (slice.label_updates[i] > pending.number + 1) continue;
    slice.labels[i] = pending.labels[i];
    slice.label_updates[i] = pending.number + 1;
  }
  if (!slice.labelled) {
    ++counts_.labelled_slices;
    ++counts_.labellings;
  }
  slice.labelled = true;
  if (!slice.points_W.empty()) newest_labelled_id_ = std::max(newest_labelled_id_, slice.id);
}

void Scene::apply_run(SceneSlice& slice, const PendingRun& pending) {
  const LabelRun& run = pending.run;
  const auto size = static_cast<std::int64_t>(slice.labels.size());
  if (run.first < 0 || run.count <= 0 || std::int64_t{run.first} + run.count > size) {
    ++counts_.ignored_runs;
    return;
  }
  const auto first = static_cast<std::size_t>(run.first);
  for (std::size_t i = first; i < first + static_cast<std::size_t>(run.count); ++i) {
    if (slice.label_updates[i] > pending.number + 1) continue;
    slice.labels[i] = run.segment_id;
    slice.label_updates[i] = pending.number + 1;
  }
}

void Scene::add_pose(const CameraPose& pose) {
  if (pose.state == TrackingState::kStarting || pose.state == TrackingState::kLost) return;
  advance_time(pose.utime);
  X_WC_ = pose.X_WC;
  const Eigen::Vector3f position_W = pose.X_WC.translation().cast<float>();
  if (path_W_.empty() || (position_W - path_W_.back()).norm() >= kPathStep_m) {
    path_W_.push_back(position_W);
  }
}

void Scene::advance_time(std::int64_t utime) {
  if (utime_ == 0) first_utime_ = utime;
  utime_ = std::max(utime_, utime);
}

std::int64_t Scene::lag_slices() const {
  const std::int64_t known = std::max(counts_.slices, announced_slices_);
  return known - counts_.labelled_slices + superseded_slices();
}

/// Labelled slices of which the segmenter knows a newer revision.
std::int64_t Scene::superseded_slices() const {
  std::int64_t count = 0;
  std::int32_t counted_id = -1;
  for (const auto& [key, pending] : pending_) {
    const SceneSlice* const here = slice(key.id);
    if (!pending.labels || here == nullptr || !here->labelled || key.id == counted_id) continue;
    counted_id = key.id;
    ++count;
  }
  return count;
}

const SceneSlice* Scene::slice(std::int32_t id) const {
  const auto found = slices_.find(id);
  return found == slices_.end() ? nullptr : &found->second;
}

const SceneSlice* Scene::newest_slice() const {
  if (newest_labelled_id_ >= 0) return slice(newest_labelled_id_);
  for (auto it = slices_.rbegin(); it != slices_.rend(); ++it) {
    if (!it->second.points_W.empty()) return &it->second;
  }
  return nullptr;
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
  return counts_.points * kBytesPerPoint +
         static_cast<std::int64_t>(pending_runs_ * sizeof(PendingRun)) +
         static_cast<std::int64_t>(path_W_.capacity() * sizeof(Eigen::Vector3f));
}

}  // namespace kintsugi::viewer
