#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// Blue, green, red, as OpenCV has them.
using Color = cv::Vec3b;

inline const Color kUnlabelledColor{120, 120, 120};

/// The colour of a segment: always the same for the same id, far apart for neighbouring ids, and
/// never grey, so that it cannot be taken for unlabelled. kNoSegment has kUnlabelledColor.
Color segment_color(std::uint32_t segment_id);

inline Color true_color(const CloudPoint& point) { return {point.blue, point.green, point.red}; }

}  // namespace kintsugi::viewer
