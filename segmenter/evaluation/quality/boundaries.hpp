#pragma once
// Compares the boundaries between segments with those between true instances.

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

struct BoundaryConfig {
  double radius_m = 0.02;  ///< a point with another label closer than this is on a boundary, > 0
  /// A boundary point is found again when one of the other labelling is no farther than this; in
  /// [0, radius_m).
  double tolerance_m = 0.01;

  /// Throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// Recall and precision are in [0, 1], and 1 when there is no boundary point.
struct BoundaryScore {
  std::int64_t num_true = 0;   ///< points on a boundary between instances
  std::int64_t num_found = 0;  ///< points on a boundary between segments
  double recall = 1.0;         ///< of the true ones, those near one between segments
  double precision = 1.0;      ///< of those between segments, those near a true one
};

/// Over the points that have an instance; kNoSegment is a label like any other.
/// @param points_W that can be segmented (reason_to_reject() names none)
/// @param instances, segments of each point
/// @throws std::invalid_argument when sizes differ, a point cannot be segmented or the config is
///   invalid
BoundaryScore boundary_score(std::span<const CloudPoint> points_W,
                             std::span<const std::uint32_t> instances,
                             std::span<const std::uint32_t> segments, const BoundaryConfig& config);

}  // namespace kintsugi::segmenter
