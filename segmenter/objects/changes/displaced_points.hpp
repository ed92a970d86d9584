#pragma once
// What cannot be where it was, because something else is there.

#include <span>
#include <vector>

#include "segmenter/objects/changes/change_groups.hpp"
#include "segmenter/objects/changes/changed_points.hpp"
#include "segmenter/objects/changes/map_side.hpp"

namespace kintsugi::segmenter {

/// No camera sees that a place is free which another thing has taken. A segment of `map` is changed
/// there, too, if a quarter of it and more is unknown and inside the room of one thing that `other`
/// alone has, deeper below its surface than both maps are exact.
/// @param changes of each point of `map`; unknown ones become changed
/// @param other_groups of `other`
void mark_displaced(const MapSide& map, std::vector<PointChange>& changes, const MapSide& other,
                    std::span<const ChangeGroup> other_groups, const Eigen::Vector3d& up,
                    const MapErrors& errors);

}  // namespace kintsugi::segmenter
