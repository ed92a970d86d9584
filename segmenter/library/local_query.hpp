#pragma once
// Queries to a map in this process, where no bus has checked them.

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// @throws std::invalid_argument naming a field that is out of its bounds, and for kPixel
void check_local(const SegmentQuery& query);

}  // namespace kintsugi::segmenter
