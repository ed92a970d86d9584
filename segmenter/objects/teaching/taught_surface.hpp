#pragma once
// Which points of a map are the object that is taught.

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/views/observed_map.hpp"

namespace kintsugi::segmenter {

struct TaughtSurface {
  std::vector<std::uint32_t> indices;      ///< of points of the map, ascending
  std::vector<std::uint32_t> segment_ids;  ///< of the map, ascending, each once
};

/// All points of these segments.
/// @throws std::runtime_error naming a segment that the map does not have and the ids next to it,
///   or that there are no ids
TaughtSurface surface_of_segments(const ObservedMap& map, std::vector<std::uint32_t> ids);

/// The points of the map that are within a voxel of one of `points_W`. The segments are those most
/// of whose points are among them.
TaughtSurface surface_at(const ObservedMap& map, std::span<const CloudPoint> points_W);

std::vector<CloudPoint> points_of(const ObservedMap& map, const TaughtSurface& surface);

}  // namespace kintsugi::segmenter
