#include "viewer/core/map/map_slice.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace kintsugi::viewer {

MapSlice::MapSlice(CloudSlice slice, const PatchPlace& place)
    : utime_(slice.utime),
      id_(slice.id),
      revision_(slice.revision),
      in_volume_(slice.in_volume),
      resolution_m_(slice.resolution_m),
      X_WC_(slice.X_WC),
      part_of_camera_(slice.part),
      is_patch_(slice.kind == SliceKind::kPatch),
      points_W_(std::move(slice.points_W)),
      labels_(points_W_.size(), kNoSegment),
      label_updates_(points_W_.size(), 0U),
      chunk_boxes_W_(chunk_boxes_of(points_W_)) {
  put(place);
}

void MapSlice::move_to(const PatchPlace& place) {
  if (is_patch_ && place.correction > place_.correction) put(place);
}

void MapSlice::put(const PatchPlace& place) {
  const bool stays = place.X_WP == place_.X_WP;
  place_ = place;
  if (stays) return;
  if (points_P_.empty()) points_P_ = std::move(points_W_);
  points_W_ = moved(points_P_, place_.X_WP);
  chunk_boxes_W_ = chunk_boxes_of(points_W_);
}

void MapSlice::append_chunks(std::vector<PointChunk>& chunks) const {
  const std::span points_W(points_W_);
  const std::span labels(labels_);
  for (std::size_t i = 0; i < chunk_boxes_W_.size(); ++i) {
    const std::size_t first = i * PointChunk::kMaxPoints;
    const std::size_t count = std::min(PointChunk::kMaxPoints, points_W.size() - first);
    chunks.push_back({points_W.subspan(first, count), labels.subspan(first, count),
                      chunk_boxes_W_[i], resolution_m_});
  }
}

UpdateEffect MapSlice::apply(const NumberedLabels& update) {
  if (update.labels.size() != labels_.size()) return UpdateEffect::kNotUsable;
  bool changed = !is_labelled_;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    changed |= set_label(i, update.labels[i], update.number);
  }
  is_labelled_ = true;
  was_labelled_ = true;
  return changed ? UpdateEffect::kChanged : UpdateEffect::kNothingNew;
}

UpdateEffect MapSlice::apply(const NumberedRun& update) {
  const LabelRun& run = update.run;
  const auto size = static_cast<std::int64_t>(labels_.size());
  if (run.first < 0 || run.count <= 0 || std::int64_t{run.first} + run.count > size) {
    return UpdateEffect::kNotUsable;
  }
  bool changed = false;
  const auto first = static_cast<std::size_t>(run.first);
  for (std::size_t i = first; i < first + static_cast<std::size_t>(run.count); ++i) {
    changed |= set_label(i, run.segment_id, update.number);
  }
  return changed ? UpdateEffect::kChanged : UpdateEffect::kNothingNew;
}

/// True when the point has another label now.
bool MapSlice::set_label(std::size_t point, std::uint32_t segment_id, std::uint32_t update_number) {
  if (label_updates_[point] > update_number + 1) return false;
  const bool changed = labels_[point] != segment_id;
  if (changed) ++label_changes_;
  labels_[point] = segment_id;
  label_updates_[point] = update_number + 1;
  return changed;
}

void MapSlice::await_new_segmenter() {
  std::ranges::fill(label_updates_, 0U);
  is_labelled_ = false;
}

void MapSlice::discard_old_labels() {
  if (is_labelled_ || !was_labelled_) return;
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    if (label_updates_[i] == 0) labels_[i] = kNoSegment;
  }
  ++label_changes_;
  was_labelled_ = false;
}

}  // namespace kintsugi::viewer
