#pragma once
// Which points of a map are not in another map of the same place.

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "segmenter/views/observed_space.hpp"

namespace kintsugi::segmenter {

enum class PointChange : std::uint8_t {
  kSame,     ///< the other map has this surface, too
  kChanged,  ///< the other map's camera has looked through it, and found nothing there
  kUnknown,  ///< the other map has no surface there, but its camera has not seen that it is free
};

/// What the other map tells about each point. A point is the same where the other map has surface
/// of a like direction within two voxels, one for the grids of both maps and one for the error of
/// the alignment; and it has changed only where views that looked through it clearly outnumber
/// those that measured something there.
/// @param points, other_points, and the views of `other_space` in one frame
std::vector<PointChange> changes_of(std::span<const CloudPoint> points,
                                    std::span<const CloudPoint> other_points,
                                    const ObservedSpace& other_space, double voxel_m);

}  // namespace kintsugi::segmenter
