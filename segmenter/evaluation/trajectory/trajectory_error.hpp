#pragma once
// How far an estimated camera path is from the true one, as the tools of the TUM RGB-D benchmark
// define it (Sturm et al., IROS 2012; associate.py, evaluate_ate.py, evaluate_rpe.py).
//
// Frames: W of the estimate, T of the truth, C the camera.

#include <cstddef>
#include <string>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/trajectory.hpp"

namespace kintsugi {

/// Of a set of errors >= 0, in their unit. The median of an even number is the mean of the middle
/// two; the standard deviation is that of the whole population.
struct ErrorStatistics {
  std::size_t count = 0;
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double std = 0.0;
  double min = 0.0;
  double max = 0.0;
};

/// All zero when there are no values.
ErrorStatistics statistics_of(std::vector<double> errors);

/// Indices into two trajectories of poses that belong together.
struct PosePair {
  std::size_t estimate = 0;
  std::size_t truth = 0;

  bool operator==(const PosePair&) const = default;
};

/// Pairs poses greedily: the two that are nearest in time first, each at most once; nothing is
/// interpolated. Of pairs equally near, the one with the earlier true pose, then with the earlier
/// estimate. In order of time.
/// @param max_difference_us a pair is closer than this
std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth,
                                std::int64_t max_difference_us = 20'000);

/// Absolute trajectory error (ATE).
struct AbsoluteTrajectoryError {
  ErrorStatistics translation_m;  ///< of the positions after alignment
  Pose X_TW = Pose::Identity();   ///< the alignment
};

/// Aligns the estimate's positions with those of the truth by the rigid motion of least squares
/// (Horn 1987, Umeyama 1991; without scale) and takes the distances that are left.
/// @throws std::invalid_argument with fewer than 3 pairs
AbsoluteTrajectoryError absolute_trajectory_error(const Trajectory& estimate,
                                                  const Trajectory& truth);

/// How far the end is off when the beginning is right, over the length of the path.
struct PathDrift {
  std::size_t num_pairs = 0;
  double path_length_m = 0.0;  ///< of the truth, from one paired pose to the next
  double end_translation_m = 0.0;
  double end_rotation_rad = 0.0;

  /// End error in percent of the path; 0 for a path without length.
  double percent() const;
};

/// Aligns the first paired poses exactly, position and orientation, and compares the last ones.
/// @throws std::invalid_argument with fewer than 3 pairs
PathDrift path_drift(const Trajectory& estimate, const Trajectory& truth);

}  // namespace kintsugi
