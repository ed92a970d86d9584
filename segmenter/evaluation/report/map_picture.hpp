#pragma once
// A picture of a labelled map, for the pages of reports.

#include <cstdint>
#include <span>
#include <string>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// The points from obliquely above, in parallel projection, each label in a colour of its own; W
/// has y downwards. Surfaces that are seen from behind, such as ceilings, are left out, unless they
/// are nearly all. Returns a PNG file; empty when there are no points.
/// @param labels one for each point
std::string map_picture_png(std::span<const CloudPoint> points_W,
                            std::span<const std::uint32_t> labels, float resolution_m);

}  // namespace kintsugi::segmenter
