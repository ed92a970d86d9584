#include "segmenter/evaluation/live/live_map.hpp"

#include <algorithm>

namespace kintsugi::segmenter {
namespace {

Eigen::Vector3d position(const CloudPoint& point) { return {point.x, point.y, point.z}; }

/// Calls visit(place) for the places of the run that exist.
template <class Visit>
void for_each_place(const LabelRun& run, std::size_t size, const Visit& visit) {
  const auto first = static_cast<std::size_t>(std::max(run.first, 0));
  const auto end = std::min(size, first + static_cast<std::size_t>(std::max(run.count, 0)));
  for (std::size_t i = first; i < end; ++i) visit(i);
}

}  // namespace

void LiveMap::add(CloudSlice slice, double now_s) {
  if (slice.superseded) return;  // its points were not sent
  resolution_m_ = slice.resolution_m;
  points_sent_ += std::ssize(slice.points_W);
  ++revisions_sent_;
  const RevisionOfSlice which(slice.id, slice.revision);
  for (const PlacedPatch& placed : motions_.learn(slice)) {
    const auto shown = shown_.find(placed.id);
    if (shown != shown_.end()) show(CloudSlice(shown->second.slice), shown->second.labels, now_s);
  }
  slices_[which] = std::move(slice);
  show_if_complete(which, now_s);
}

void LiveMap::add(const SegmentUpdate& update, double now_s) {
  for (const SegmentEvent& event : update.events) {
    if (event.type == SegmentEventType::kMerged) heirs_.add(event.other_id, event.segment_id);
  }
  const RevisionOfSlice which(update.slice_id, update.slice_revision);
  const auto shown = shown_.find(update.slice_id);
  if (shown != shown_.end() && shown->second.revision == update.slice_revision) {
    // A full state: labels of what is shown already.
    show(CloudSlice(shown->second.slice), update.labels, now_s);
  } else {
    labels_[which] = update.labels;
    show_if_complete(which, now_s);
  }
  for (const LabelRun& run : update.runs) relabel(run, now_s);
}

void LiveMap::relabel(const LabelRun& run, double now_s) {
  if (const auto waiting = labels_.find({run.slice_id, run.slice_revision});
      waiting != labels_.end()) {
    for_each_place(run, waiting->second.size(),
                   [&](std::size_t i) { waiting->second[i] = run.segment_id; });
    return;
  }
  const auto found = shown_.find(run.slice_id);
  if (found == shown_.end() || found->second.revision != run.slice_revision) return;
  Shown& shown = found->second;
  for_each_place(run, shown.labels.size(), [&](std::size_t i) {
    if (shown.labels[i] == kNoSegment || run.segment_id == kNoSegment) return;
    regions_.remove_point(position(shown.points_W[i]), shown.labels[i]);
    regions_.add_point(position(shown.points_W[i]), run.segment_id, now_s);
    shown.labels[i] = run.segment_id;
  });
}

void LiveMap::show_if_complete(const RevisionOfSlice& which, double now_s) {
  const auto slice = slices_.find(which);
  const auto labels = labels_.find(which);
  if (slice == slices_.end() || labels == labels_.end()) return;
  show(std::move(slice->second), std::move(labels->second), now_s);
  // What waits of lower revisions will not be shown any more.
  const RevisionOfSlice lowest(which.first, 0);
  slices_.erase(slices_.lower_bound(lowest), std::next(slice));
  labels_.erase(labels_.lower_bound(lowest), std::next(labels));
}

void LiveMap::show(CloudSlice slice, Labels labels, double now_s) {
  const std::int32_t slice_id = slice.id;
  Shown& shown = shown_[slice_id];
  if (slice.revision < shown.revision || slice.points_W.size() != labels.size()) return;
  grid_.erase(slice_id, shown.points_W);
  for (std::size_t i = 0; i < shown.points_W.size(); ++i) {
    if (shown.labels[i] == kNoSegment) continue;
    regions_.remove_point(position(shown.points_W[i]), shown.labels[i]);
    --num_points_;
  }
  shown.revision = slice.revision;
  shown.points_W = moved(slice.points_W, motions_.place_of(slice).X_WP);
  shown.slice = std::move(slice);
  shown.labels = std::move(labels);
  for (std::size_t i = 0; i < shown.points_W.size(); ++i) {
    if (shown.labels[i] == kNoSegment) continue;
    const CloudPoint& p = shown.points_W[i];
    grid_.insert({p.x, p.y, p.z, slice_id, static_cast<std::int32_t>(i)});
    regions_.add_point(position(p), shown.labels[i], now_s);
    first_labels_.add(position(p), now_s);
    ++num_points_;
  }
}

void LiveMap::take(const PlacedPoint& point, FoundPoints& found) const {
  const Shown& shown = shown_.at(point.slice_id);
  found.points_W.push_back(shown.points_W[static_cast<std::size_t>(point.index)]);
  found.segment_ids.push_back(shown.labels[static_cast<std::size_t>(point.index)]);
}

std::uint32_t LiveMap::segment_of(const PlacedPoint& point) const {
  return shown_.at(point.slice_id).labels[static_cast<std::size_t>(point.index)];
}

}  // namespace kintsugi::segmenter
