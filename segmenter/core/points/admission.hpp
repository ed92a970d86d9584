#pragma once
// Which points may enter the map.

#include <optional>
#include <string_view>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Larger coordinates can only be a mistake, and would not fit the neighbour grid.
inline constexpr float kMaxCoordinate_m = 1e6F;

/// The length of a normal may differ from 1 by this much. Eq. 2 assumes a unit vector.
inline constexpr float kNormalLengthTolerance = 0.01F;

/// The reason why `point` cannot be segmented; nothing when it can.
std::optional<std::string_view> reason_to_reject(const CloudPoint& point);

/// The same for the position alone, for clouds whose normals are computed later.
std::optional<std::string_view> reason_to_reject_position(const CloudPoint& point);

}  // namespace kintsugi::segmenter
