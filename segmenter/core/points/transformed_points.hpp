#pragma once
// Points of a map in another frame.

#include <span>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// The point, with its normal, where `X_BA` puts it.
CloudPoint transformed(const CloudPoint& point_A, const Pose& X_BA);
std::vector<CloudPoint> transformed(const Pose& X_BA, std::span<const CloudPoint> points_A);

}  // namespace kintsugi::segmenter
