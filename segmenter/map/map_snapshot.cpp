#include "segmenter/map/map_snapshot.hpp"

#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

#include "segmenter/core/points/admission.hpp"
#include "segmenter/map/segment_sums.hpp"

namespace kintsugi::segmenter {
namespace {

bool is_complete(const SegmentMapState& state) {
  std::set<std::int32_t> ids;
  std::int64_t revision_sum = 0;
  for (const SliceRecord& slice : state.slices) {
    revision_sum += slice.revision;
    if (slice.slice_id <= state.final_slice_id) ids.insert(slice.slice_id);
  }
  return state.final_slice_id >= 0 && std::ssize(ids) == std::int64_t{state.final_slice_id} + 1 &&
         revision_sum >= state.final_revision_sum;
}

std::vector<SegmentStatistics> statistics_of(const SegmentMapState& state) {
  std::unordered_map<std::uint32_t, SegmentSums> sums;
  for (const SliceRecord& slice : state.slices) {
    for (PointIndex i = slice.first; i < slice.first + slice.count; ++i) {
      if (state.segment_ids[i] == kNoSegment) continue;
      const CloudPoint& point = state.points_W[i];
      if (const auto reason = reason_to_reject_position(point); reason.has_value()) {
        throw std::invalid_argument("point " + std::to_string(i) + ": " + std::string(*reason));
      }
      SegmentSums& segment = sums[state.segment_ids[i]];
      segment.add(point, slice.is_in_volume(), 1);
      segment.extent.include(point, slice.slice_id);
    }
  }
  const auto resolution_m = static_cast<float>(state.config.engine.resolution_m);
  std::map<std::uint32_t, SegmentStatistics> by_id;
  for (const auto& [id, segment] : sums) by_id[id] = segment.statistics(id, resolution_m);
  std::vector<SegmentStatistics> statistics;
  statistics.reserve(by_id.size());
  for (const auto& [id, segment] : by_id) statistics.push_back(segment);
  return statistics;
}

}  // namespace

void take_snapshot(const SegmentMap& map, MapSnapshot& snapshot) {
  map.copy_state(snapshot.state);
  snapshot.is_complete = map.is_complete();
  snapshot.segments = map.statistics().all();
}

MapSnapshot take_snapshot(const SegmentMap& map) {
  MapSnapshot snapshot;
  take_snapshot(map, snapshot);
  return snapshot;
}

MapSnapshot make_snapshot(SegmentMapState state) {
  MapSnapshot snapshot;
  snapshot.segments = statistics_of(state);
  snapshot.is_complete = is_complete(state);
  if (!state.last_changes.empty() && state.last_changes.size() != snapshot.segments.size()) {
    throw std::invalid_argument(std::to_string(snapshot.segments.size()) + " segments, but " +
                                std::to_string(state.last_changes.size()) + " last changes");
  }
  snapshot.state = std::move(state);
  return snapshot;
}

}  // namespace kintsugi::segmenter
