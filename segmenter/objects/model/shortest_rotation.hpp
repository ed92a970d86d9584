#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kintsugi::segmenter {

/// The rotation by the smallest angle that turns `from` towards `to`; of opposite directions any of
/// those by half a turn. Eigen's FromTwoVectors for numbers of this type, compiled once for all of
/// segmenter/objects: the singular value decomposition in it takes the compiler 6 s.
Eigen::Quaterniond shortest_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace kintsugi::segmenter
