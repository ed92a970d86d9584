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

}  // namespace kintsugi::segmenter
