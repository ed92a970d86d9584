#include "viewer/core/charts/segment_timeline.hpp"

#include <algorithm>
#include <optional>
#include <unordered_map>

namespace kintsugi::viewer {
namespace {

using EventType = SegmentTimeline::EventType;
using PointCounts = std::unordered_map<std::uint32_t, std::uint32_t>;  // by segment

/// What an event means for this segment; nothing when it is about other segments.
std::optional<EventType> role_of(std::uint32_t segment_id, const SegmentEvent& event) {
  const bool is_subject = event.segment_id == segment_id;
  if (!is_subject && event.other_id != segment_id) return std::nullopt;
  switch (event.type) {
    case SegmentEventType::kCreated:
      return EventType::kCreated;
    case SegmentEventType::kMerged:
      return is_subject ? EventType::kAbsorbed : EventType::kMergedInto;
    case SegmentEventType::kSplit:
      return is_subject ? EventType::kSplit : EventType::kSplitOff;
    case SegmentEventType::kRetired:
      return EventType::kRetired;
    case SegmentEventType::kGrown:
      break;  // shown by the sizes
  }
  return std::nullopt;
}

bool is_end(EventType type) {
  return type == EventType::kMergedInto || type == EventType::kRetired;
}

/// Of several sizes at the same number of slices (corrections add none) the last counts.
void append(std::vector<SegmentTimeline::Size>& sizes, SegmentTimeline::Size size) {
  if (!sizes.empty() && sizes.back().num_slices == size.num_slices) sizes.pop_back();
  if (sizes.empty() || sizes.back().num_points != size.num_points) sizes.push_back(size);
}

void append_events(SegmentTimeline& timeline, const UpdateLog::Entry& entry,
                   const PointCounts& before, const PointCounts& after) {
  for (const SegmentEvent& event : entry.events) {
    const auto type = role_of(timeline.segment_id, event);
    if (!type) continue;
    const bool is_subject = event.segment_id == timeline.segment_id;
    const std::uint32_t other = is_subject ? event.other_id : event.segment_id;
    const PointCounts& counts = *type == EventType::kAbsorbed ? before : after;
    const auto found = counts.find(other);
    const bool has_other = *type != EventType::kCreated && *type != EventType::kRetired;
    timeline.events.push_back({entry.num_slices, *type, has_other ? other : 0,
                               has_other && found != counts.end() ? found->second : 0});
    if (is_end(*type)) append(timeline.sizes, {entry.num_slices, 0});
  }
}

}  // namespace

bool SegmentTimeline::has_beginning() const {
  return std::ranges::any_of(events, [](const Event& event) {
    return event.type == EventType::kCreated || event.type == EventType::kSplitOff;
  });
}

SegmentTimeline timeline_of(std::uint32_t segment_id, const UpdateLog& log) {
  SegmentTimeline timeline;
  timeline.segment_id = segment_id;
  if (segment_id == kNoSegment) return timeline;  // events without another segment name it
  PointCounts before;
  for (const UpdateLog::Entry* entry : log.entries()) {
    timeline.num_slices = std::max(timeline.num_slices, entry->num_slices);
    PointCounts after;
    for (const UpdateLog::Size& size : entry->sizes) {
      after[size.segment_id] = size.num_points;
      if (size.segment_id == segment_id) {
        append(timeline.sizes, {entry->num_slices, size.num_points});
      }
    }
    append_events(timeline, *entry, before, after);
    for (const auto& [id, num_points] : after) before[id] = num_points;
  }
  return timeline;
}

}  // namespace kintsugi::viewer
