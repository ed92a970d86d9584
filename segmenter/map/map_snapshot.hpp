#pragma once
// A segment map at one moment, to be written while the map goes on.

#include <cstdint>
#include <vector>

#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {

/// All that files tell of a map. A copy, so that another thread can write it.
struct MapSnapshot {
  SegmentMapState state;
  bool is_complete = false;                 ///< the final slice and every earlier one are in it
  std::vector<SegmentStatistics> segments;  ///< by ascending id
};

/// Into `snapshot`, whose memory is used again: fresh memory takes most of the time of a copy.
void take_snapshot(const SegmentMap& map, MapSnapshot& snapshot);
MapSnapshot take_snapshot(const SegmentMap& map);

/// Of a map that is not gone on with: no engine runs, and segments are what `state` says they are.
/// Throws std::invalid_argument naming what is wrong when a segment has a point whose position
/// cannot be used, or when `state` has last changes, but not one for each segment.
MapSnapshot make_snapshot(SegmentMapState state);

}  // namespace kintsugi::segmenter
