#pragma once
// Which points may enter the map.

#include <optional>
#include <string_view>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Coordinates beyond this are no map but a mistake, and would not fit the neighbour grid.
inline constexpr float kMaxCoordinate_m = 1e6F;

/// A normal's length may differ from 1 by this much: Eq. 2 takes it for a unit vector.
inline constexpr float kNormalLengthTolerance = 0.01F;

/// Why `point` cannot be segmented; nothing when it can.
std::optional<std::string_view> reason_to_reject(const CloudPoint& point);

/// The same for its position alone: a cloud whose normals are still to be computed.
std::optional<std::string_view> reason_to_reject_position(const CloudPoint& point);

}  // namespace kintsugi::segmenter
