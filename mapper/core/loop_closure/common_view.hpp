#pragma once

#include "lcmtypes/geometry.hpp"
#include "mapper/core/relocalization/keyframe_map.hpp"

namespace kintsugi::mapper {

/// Share of the points that keyframe L sees which E would see, too, with L at this pose in E.
double common_share(const Keyframe& L, const Keyframe& E, const Pose& X_EL);

}  // namespace kintsugi::mapper
