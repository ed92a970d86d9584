#pragma once
// The unit of a file's coordinates.

#include <string>
#include <string_view>
#include <vector>

namespace kintsugi::segmenter {

/// The unit that the comments of a header tell, as "unit mm" (kintsugi-segment-cloud writes this):
/// m, cm or mm, by the last such comment. Empty: none does.
std::string unit_told_by(const std::vector<std::string>& comments);

/// 0.001 for mm, 0.01 for cm; 1 for m and where the unit is not known (empty).
double metres_per(std::string_view unit);

}  // namespace kintsugi::segmenter
