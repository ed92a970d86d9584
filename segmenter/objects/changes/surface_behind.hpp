#pragma once
// Surface that is nearer behind a place than one view can tell.

#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/objects/changes/map_side.hpp"

namespace kintsugi::segmenter {

/// Whether the map has a surface of the same direction behind each point, farther than `same_m`, up
/// to which it is the same surface, and at most 5 cm. What views measured there, whose noise is as
/// large, is then that surface: the map, which is made of many views, is more exact.
std::vector<bool> have_surface_behind(std::span<const CloudPoint> points, const MapSide& map,
                                      double same_m);

}  // namespace kintsugi::segmenter
