#pragma once
// The answer to a query about the segments of a map.

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

struct MapExcerpt;
struct MapSnapshot;

/// Answers `query`, whose fields must be within the bounds of the codec, from `map`. Sets every
/// field except SegmentAnswer::utime. The answer depends only on the arguments. map_name and
/// map_session of the query are ignored: choose_map() finds the map that is meant.
///
/// Takes time proportional to the points of the map; with only_planar, or for many segments, some
/// hundred nanoseconds for each point.
///
/// @param view what the camera of the map sees now, for QueryPlace::kPixel; null: not known
/// @throws std::invalid_argument with a text for the client when the pixel is outside the image
SegmentAnswer answer(const MapSnapshot& map, const SegmentQuery& query,
                     const CameraView* view = nullptr);

/// The same from what was taken of a map for this query.
SegmentAnswer answer(const MapExcerpt& excerpt, const SegmentQuery& query);

}  // namespace kintsugi::segmenter
