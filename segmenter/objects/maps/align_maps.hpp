#pragma once
// Puts two maps of the same place one on the other.

#include <optional>
#include <string>

#include "lcmtypes/geometry.hpp"
#include "segmenter/views/observed_map.hpp"

namespace kintsugi::segmenter {

struct MapAlignment {
  Pose X_AB = Pose::Identity();  ///< of BEFORE's W in AFTER's W
  /// Of the distances between surfaces of both maps that are one surface, metres, along its normal.
  double rms_m = 0.0;
  double sigma_m = 0.0;    ///< estimated standard deviation of the position, in the worst direction
  double sigma_rad = 0.0;  ///< and of the rotation
  /// Share of the surface of the smaller map that the other one has, too.
  double overlap = 0.0;
  /// Of the surface of both maps that the other map's views could see, the share that was there.
  double agreement = 0.0;
};

/// Either an alignment, or why there is none.
struct AlignmentResult {
  std::optional<MapAlignment> alignment;
  std::string refusal;  ///< empty: there is one
};

/// Both maps may begin anywhere, with any yaw. Things may have come, gone and moved, and the light
/// may differ. An alignment is given only where
///   - the surface of each map that the other map's views could see is there, but for changes,
///   - enough of the smaller map is in the other, and
///   - no other place fits nearly as well: shape, free space and colours decide together.
/// It is deterministic.
AlignmentResult align_maps(const ObservedMap& before, const ObservedMap& after);

}  // namespace kintsugi::segmenter
