#pragma once
// A thing of which only a part is changed: what else belongs to it.

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "segmenter/objects/changes/change_groups.hpp"
#include "segmenter/objects/changes/filled_space.hpp"
#include "segmenter/objects/changes/map_side.hpp"

namespace kintsugi::segmenter {

struct Thing {
  std::vector<std::size_t> points;   ///< indices in its map, ascending
  std::set<std::uint32_t> segments;  ///< all of whose points are in it
};

/// The points of the group, and the segments that are not so much larger that the group is only at
/// their rim, as of a table on which something stood.
Thing thing_of(const ChangeGroup& group, const MapSide& map);

/// The segments of a map that are, but for a little, in the room that a thing takes in the other.
Thing what_is_there(std::span<const CloudPoint> thing, const MapSide& map,
                    const Eigen::Vector3d& up);

/// Adds the segments that touch the thing, or are in its room, and move with it: what is to be seen
/// of them in the other map is there after the motion, and either not as well without it, or they
/// are in the room that the thing takes.
/// @param X moves the thing to where it is in `other`
/// @param all surface of the thing as it is in `map`, as far as both maps have it
/// @return whether there were any
bool add_what_follows(Thing& thing, const MapSide& map, const Pose& X, const MapSide& other,
                      std::span<const CloudPoint> all, const Eigen::Vector3d& up);

/// Takes the segments away that stay where they are better than they move with the thing, as a
/// part of the table does that is in one segment with what lies on it; but never all points.
void drop_what_stays(Thing& thing, const MapSide& map, const Pose& X, const MapSide& other);

/// Whether the points are in the room of a thing, and nothing speaks against that they moved with
/// it.
/// @param room, X as above
bool is_part_of(std::span<const std::size_t> points, const MapSide& map, const FilledSpace& room,
                const Pose& X, const MapSide& other);

/// Sides of its box, with z along `up`.
Eigen::Vector3d size_of(std::span<const CloudPoint> points, const Eigen::Vector3d& up);

}  // namespace kintsugi::segmenter
