#include "segmenter/map/map_parts.hpp"

#include <cstddef>
#include <span>
#include <unordered_set>
#include <utility>

namespace kintsugi::segmenter {
namespace {

void copy_names(const SegmentMapState& from, SegmentMapState& to) {
  to.config = from.config;
  to.session = from.session;
  to.map_session = from.map_session;
  to.map_name = from.map_name;
  to.final_slice_id = from.final_slice_id;
  to.final_revision_sum = from.final_revision_sum;
  to.next_id = from.next_id;
}

void append_slice(const SegmentMapState& from, SliceRecord slice, SegmentMapState& to) {
  const auto points_W = std::span(from.points_W).subspan(slice.first, slice.count);
  const auto segment_ids = std::span(from.segment_ids).subspan(slice.first, slice.count);
  slice.first = static_cast<PointIndex>(to.points_W.size());
  to.points_W.insert(to.points_W.end(), points_W.begin(), points_W.end());
  to.segment_ids.insert(to.segment_ids.end(), segment_ids.begin(), segment_ids.end());
  to.slices.push_back(std::move(slice));
}

/// Those of which `to` has points.
void copy_segments(const MapSnapshot& from, MapSnapshot& to) {
  const std::unordered_set<std::uint32_t> ids(to.state.segment_ids.begin(),
                                              to.state.segment_ids.end());
  for (std::size_t i = 0; i < from.segments.size(); ++i) {
    if (!ids.contains(from.segments[i].segment_id)) continue;
    to.segments.push_back(from.segments[i]);
    if (from.state.last_changes.empty()) continue;
    to.state.last_changes.push_back(from.state.last_changes[i]);
  }
}

}  // namespace

std::set<std::int32_t> parts_of(const MapSnapshot& map) {
  std::set<std::int32_t> parts{0};
  for (const SliceRecord& slice : map.state.slices) {
    if (slice.count > 0) parts.insert(slice.place.part);
  }
  return parts;
}

MapSnapshot only_part(const MapSnapshot& map, std::int32_t part) {
  MapSnapshot only;
  only.is_complete = map.is_complete;
  copy_names(map.state, only.state);
  for (const SliceRecord& slice : map.state.slices) {
    if (slice.place.part == part) append_slice(map.state, slice, only.state);
  }
  copy_segments(map, only);
  return only;
}

}  // namespace kintsugi::segmenter
