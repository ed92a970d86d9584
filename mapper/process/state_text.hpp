#pragma once
// How a frame went, in words: for logs, tables and status.

#include <string_view>

#include "mapper/core/tracking/tracker.hpp"

namespace kintsugi::mapper {

/// Why a lost frame was not believed; empty for any other.
std::string_view reason_text(const TrackingResult& tracking);

}  // namespace kintsugi::mapper
