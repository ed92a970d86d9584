#pragma once
// What a map says about a surface that should be in it.

#include <cstddef>
#include <span>

#include "lcmtypes/geometry.hpp"
#include "segmenter/objects/changes/map_side.hpp"

namespace kintsugi::segmenter {

/// Shares of the surface's points.
struct Evidence {
  double found = 0.0;         ///< the map has such a surface there, of like colour
  double contradicted = 0.0;  ///< it was looked through, or something else is there

  [[nodiscard]] double known() const { return found + contradicted; }
  /// Of what is to be seen of it; 0 where nothing is.
  [[nodiscard]] double agreement() const {
    return found > 0.0 ? found / (found + contradicted) : 0.0;
  }
};

/// @param points of `from`
/// @param X moves them to where they are looked for in `map`
/// @param counterpart ascending indices of points of `map`: only these count as found; what is on
///   others says nothing. Empty: all points of `map` count
Evidence evidence_of(const MapSide& from, std::span<const std::size_t> points, const Pose& X,
                     const MapSide& map, std::span<const std::size_t> counterpart = {});

}  // namespace kintsugi::segmenter
