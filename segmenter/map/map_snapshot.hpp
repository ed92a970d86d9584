#pragma once
// A copy of a segment map, to be written while the map changes.

#include <cstdint>
#include <vector>

#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {

/// Everything that files hold of a map. It is a copy, so that another thread can write it.
struct MapSnapshot {
  SegmentMapState state;
  bool is_complete = false;                 ///< as SegmentMap::is_complete()
  std::vector<SegmentStatistics> segments;  ///< by ascending id
};

/// Copies into `snapshot` and reuses its memory: most of the time of a copy goes into new memory.
void take_snapshot(const SegmentMap& map, MapSnapshot& snapshot);
MapSnapshot take_snapshot(const SegmentMap& map);

/// A snapshot of a map that will not be continued: no engine runs, and the segments are those of
/// `state`.
/// @throws std::invalid_argument naming the reason when a segment has a point with an inadmissible
///   position, or when `state` has last changes, but not one for each segment
MapSnapshot make_snapshot(SegmentMapState state);

}  // namespace kintsugi::segmenter
