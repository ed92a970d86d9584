#pragma once
// The answer of a map to a question about its segments.

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

struct MapSnapshot;

/// What `map` has to say to `query`, whose fields are within the bounds of the codec. Everything
/// but SegmentAnswer::utime is filled in; the same for the same map and query. Which map is meant
/// is the caller's to find out: map_name and map_session of the query are not looked at.
///
/// Takes time in proportion to the points of the map; with only_planar, or many segments to
/// describe, some hundred nanoseconds for each.
SegmentAnswer answer(const MapSnapshot& map, const SegmentQuery& query);

}  // namespace kintsugi::segmenter
