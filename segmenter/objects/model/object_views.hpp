#pragma once
// From where an object was seen.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"
#include "segmenter/views/map_view.hpp"

namespace kintsugi::segmenter {

/// Unit vectors from the origin of O towards the cameras whose depth images have a part of the
/// object; directions less than about 10 degrees apart count once.
/// @param resolution_m voxel size of the map, > 0
std::vector<Eigen::Vector3f> directions_of_views(std::span<const CloudPoint> points_O,
                                                 const Pose& X_WO,
                                                 std::span<const MapView> views,
                                                 float resolution_m);

/// Adds those of `more` that are not near one of `directions`.
void merge_directions(std::vector<Eigen::Vector3f>& directions,
                      std::span<const Eigen::Vector3f> more);

}  // namespace kintsugi::segmenter
