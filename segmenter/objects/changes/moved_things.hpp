#pragma once
// Which things are in both maps, but at another place.

#include <cstddef>
#include <span>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "segmenter/objects/changes/change_groups.hpp"
#include "segmenter/objects/changes/changed_points.hpp"
#include "segmenter/objects/changes/map_errors.hpp"
#include "segmenter/objects/changes/map_side.hpp"
#include "segmenter/objects/changes/whole_thing.hpp"

namespace kintsugi::segmenter {

/// A map with what is changed in it.
struct ChangedSide {
  const MapSide& map;
  std::span<const PointChange> changes;  ///< of each point
  std::span<const ChangeGroup> groups;
};

struct MovedThing {
  Thing before;
  Thing after;
  Pose X_after_before = Pose::Identity();  ///< maps its points before to where they are now
  double score = 0.0;   ///< 0 to 1: how much of all that is to be seen of it agrees
  double points = 0.0;  ///< of both maps that the other has, too
};

/// What both maps have of it, where it is now.
std::vector<CloudPoint> whole_surface(const MovedThing& moved, const MapSide& before,
                                      const MapSide& after);

/// Things that still stand upright, those first of which most is found again; no two share more
/// than a little.
///
/// Each group of changed points with the segments that are its own is looked for in the other map,
/// by ObjectRecognizer, at the groups there that may be of its size and colours; and where it was,
/// for what was turned or pushed aside a little. What moves with it is added. It has moved when
/// nearly all that is to be seen of it in each map agrees with the other, the same place would not
/// do as well, and some point of it moves by more than the maps' errors.
/// @param up unit vector
std::vector<MovedThing> find_moved(const ChangedSide& before, const ChangedSide& after,
                                   const Eigen::Vector3d& up, const MapErrors& errors);

}  // namespace kintsugi::segmenter
