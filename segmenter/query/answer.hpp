#pragma once
// The answer to a query about the segments of a map.

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

struct MapSnapshot;

/// Answers `query`, whose fields must be within the bounds of the codec, from `map`. Sets every
/// field except SegmentAnswer::utime. The answer depends only on map and query. map_name and
/// map_session of the query are ignored: choose_map() finds the map that is meant.
///
/// Takes time proportional to the points of the map; with only_planar, or for many segments, some
/// hundred nanoseconds for each point.
SegmentAnswer answer(const MapSnapshot& map, const SegmentQuery& query);

}  // namespace kintsugi::segmenter
