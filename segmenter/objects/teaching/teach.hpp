#pragma once
// Makes an object of the library from what is in a map.

#include <cstdint>
#include <span>
#include <string>

#include "lcmtypes/messages.hpp"
#include "segmenter/objects/library/known_object.hpp"
#include "segmenter/objects/teaching/taught_surface.hpp"
#include "segmenter/views/observed_map.hpp"

namespace kintsugi::segmenter {

/// The object as it is known from this map alone: its model, the parameters under which it comes out
/// whole, and one lesson.
/// @param points_W of the object, in W of the map
/// @param surface the same in the map's own points
/// @param time_s of the lesson
/// @throws std::runtime_error naming the reason: no usable point, or so few that the preset
///   `objects` would join such a segment to its neighbour
KnownObject taught_object(const std::string& name, const ObservedMap& map,
                          std::span<const CloudPoint> points_W, const TaughtSurface& surface,
                          std::int64_t time_s);

}  // namespace kintsugi::segmenter
