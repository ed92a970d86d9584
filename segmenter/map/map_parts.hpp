#pragma once
// The parts of a map: what no loop has joined yet (CloudSlice::part).

#include <cstdint>
#include <set>

#include "segmenter/map/map_snapshot.hpp"

namespace kintsugi::segmenter {

/// The parts that have points, and always part 0.
std::set<std::int32_t> parts_of(const MapSnapshot& map);

/// What describes one part of a map, which keeps its coordinates: the slices that are in it by now,
/// with their points and rejected points, and the segments of these points. Parts lie so far apart
/// that no segment is in two. It is for files to be read, not to be continued: without chunks,
/// motions and thetas.
MapSnapshot only_part(const MapSnapshot& map, std::int32_t part);

}  // namespace kintsugi::segmenter
