#pragma once
// The tracking result of a frame as text, for logs, tables and status.

#include <string_view>

#include "mapper/core/tracking/tracker.hpp"

namespace kintsugi::mapper {

/// Why tracking was lost at this frame; empty for other frames.
std::string_view reason_text(const TrackingResult& tracking);

/// Why the pose that continues the camera's motion was rejected; empty where it was not. A wide
/// search may have found the camera all the same, or been rejected for another reason.
std::string_view first_reason_text(const TrackingResult& tracking);

}  // namespace kintsugi::mapper
