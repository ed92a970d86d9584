#pragma once
// How far the camera's motions are from the true ones (evaluate_rpe.py of the TUM RGB-D benchmark).

#include <cstddef>
#include <cstdint>
#include <string>

#include "lcmtypes/trajectory.hpp"
#include "segmenter/evaluation/trajectory/trajectory_error.hpp"

namespace kintsugi {

/// What the interval between the two poses of a motion is measured in, along the estimate.
enum class DeltaUnit : std::int8_t { kSeconds, kFrames, kMetres, kDegrees };

struct RelativeTrajectoryErrorConfig {
  double delta = 1.0;  ///< in `delta_unit`, > 0
  DeltaUnit delta_unit = DeltaUnit::kSeconds;
  /// From each pose to the one nearest to `delta` after it; a motion that would go to the last pose
  /// is left out, as it may be cut short. Else `delta` means nothing: every pose to every other and
  /// itself, both ways, or `max_pairs` of them drawn at random (always the same) when the square of
  /// the number of poses is more.
  bool fixed_delta = true;
  std::size_t max_pairs = 10'000;  ///< without fixed_delta, > 0

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// Relative pose error (RPE): of the motions (X_WC0^-1 X_WC1)^-1 of the estimate and of the truth,
/// what one has more than the other.
struct RelativeTrajectoryError {
  ErrorStatistics translation_m;
  ErrorStatistics rotation_rad;
};

/// For each estimated pose counts the true pose nearest in time, however far; a motion is left out
/// where that is farther than twice the median interval of the truth.
/// @throws std::invalid_argument when the configuration is not valid, when a trajectory has fewer
///   than 2 poses, or when fewer than 2 motions have true ones
RelativeTrajectoryError relative_trajectory_error(const Trajectory& estimate,
                                                  const Trajectory& truth,
                                                  const RelativeTrajectoryErrorConfig& config);

}  // namespace kintsugi
