#pragma once
// A segment map at one moment, to be looked at while the map goes on.

#include <cstdint>
#include <string>
#include <vector>

#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {

/// What a person or another program may want to know of a map: points with their segments, and
/// statistics. A copy, so that it can be written on another thread: 36 bytes a point.
struct MapSnapshot {
  SegmentMapConfig config;
  std::string map_name;
  std::int64_t map_session = 0;
  std::int64_t session = 0;
  bool is_complete = false;                 ///< the final slice and every earlier one are in it
  std::vector<SliceRecord> slices;          ///< in the order of their arrival
  std::vector<CloudPoint> points_W;         ///< accepted points, slice after slice, frame W
  std::vector<std::uint32_t> segment_ids;   ///< of each point
  std::vector<SegmentStatistics> segments;  ///< by ascending id
  std::int64_t num_points_rejected = 0;
};

/// Also of a map whose last add() threw: points that have no segment then carry kNoSegment.
MapSnapshot take_snapshot(const SegmentMap& map);

}  // namespace kintsugi::segmenter
