#pragma once
// Whether a thing is another one that has moved.

#include <optional>
#include <span>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

struct ObjectMotion {
  Pose X_after_before = Pose::Identity();  ///< in W: maps the points before to where they are now
  double score = 0.0;  ///< 0 to 1: share of both surfaces that meet, times likeness of colour
};

/// The motion of a thing that still stands upright: any translation, any turn about the vertical.
/// Nothing: size, shape or colour are another's.
/// @param before, after its points, in one W; the light of both is alike
/// @param up_W unit vector
std::optional<ObjectMotion> motion_between(std::span<const CloudPoint> before,
                                           std::span<const CloudPoint> after,
                                           const Eigen::Vector3d& up_W, double voxel_m);

}  // namespace kintsugi::segmenter
