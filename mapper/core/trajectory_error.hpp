#pragma once

#include "mapper/core/trajectory.hpp"

namespace kintsugi::mapper {

struct TrajectoryError {
  int pairs = 0;        ///< poses of the estimate with a true pose within 20 ms
  double rmse_m = 0.0;  ///< of the translations after alignment
  double median_m = 0.0;
  double max_m = 0.0;
};

/// Absolute trajectory error as the TUM benchmark defines it: the estimate's translations are
/// aligned with the truth by the rigid motion of least squares (Umeyama 1991, without scale).
/// @throws std::invalid_argument with fewer than 3 pairs
TrajectoryError absolute_trajectory_error(const Trajectory& estimate, const Trajectory& truth);

}  // namespace kintsugi::mapper
