#pragma once
// The exact motion of a thing from a rough one.

#include <span>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// The motion of a thing that still stands upright: any translation, any turn about `up`. Iterative
/// closest points both ways: where both surfaces end, their edges are put on each other, too, which
/// alone holds a flat thing.
/// @param before, after surface of the thing alone, not empty
/// @param X_after_before rough motion, which need not be upright; right within `reach_m`
/// @param up unit vector
Pose refined_motion(std::span<const CloudPoint> before, std::span<const CloudPoint> after,
                    const Pose& X_after_before, const Eigen::Vector3d& up, double voxel_m,
                    double reach_m);

}  // namespace kintsugi::segmenter
