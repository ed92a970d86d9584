#pragma once
// Which points of a map are not in another map of the same place.

#include <cstdint>
#include <vector>

#include "segmenter/objects/changes/map_errors.hpp"
#include "segmenter/objects/changes/map_side.hpp"

namespace kintsugi::segmenter {

enum class PointChange : std::uint8_t {
  kSame,       ///< the other map has this surface, too
  kChanged,    ///< the other map's camera has found that there is nothing there
  kUnknown,    ///< the other map has no surface there, but its camera has not seen that it is free
  kRecolored,  ///< the other map has surface there, but of another colour
};

/// What the other map tells about each point. A point is the same where the other map has surface
/// of a like direction within the maps' errors; and it has changed only where views that looked
/// through it clearly outnumber those that measured something there. What they measured may be a
/// surface behind it that is nearer than the noise of one view can tell, but not than the map can,
/// which is made of many.
std::vector<PointChange> changes_of(const MapSide& map, const MapSide& other,
                                    const MapErrors& errors);

}  // namespace kintsugi::segmenter
