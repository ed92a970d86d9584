#pragma once

#include <algorithm>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/trajectory.hpp"

namespace kintsugi::mapper {

/// The larger of the distance (m) and of the angle (rad) of a motion: about as far moves what is a
/// metre away.
inline double motion_size(const Pose& X) {
  return std::max(X.translation().norm(), rotation_angle_rad(X));
}

}  // namespace kintsugi::mapper
