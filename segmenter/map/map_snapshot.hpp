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

MapSnapshot take_snapshot(const SegmentMap& map);

}  // namespace kintsugi::segmenter
