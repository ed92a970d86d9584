#pragma once
// How well a run kept its path: errors on both sides, and the time until a lost camera is found.

#include <optional>
#include <vector>

#include "tests/bench/recovery_run.hpp"

namespace kintsugi::mapper::bench {

struct RecoveryMeasures {
  int frames = 0;
  int located = 0;
  /// Located more than kWrong_m off what frames fused rightly at the same place say: fused wrongly.
  /// Drift over a long way, which is no wrong fusion, does not count. Places are told by the
  /// reference and by the truth; neither is exact for a recording, so a frame is wrong by both.
  int misplaced = 0;
  double worst_misplacement_m = 0.0;
  int off = 0;                     ///< located more than kWrong_m off the reference, drift and all
  double worst_error_m = 0.0;      ///< of the located ones, against the reference
  int good = 0;                    ///< see is_good()
  int refused = 0;                 ///< good and yet not located
  int recoveries = 0;              ///< losses with a good frame that ended with a located one
  int never_recovered = 0;         ///< losses with a good frame that lasted to the end
  double median_recovery_s = 0.0;  ///< from the first good frame of a loss to the located one
  double max_recovery_s = 0.0;
  std::optional<double> ate_m;  ///< RMSE after alignment with the recording's own truth
  double median_frame_ms = 0.0;
  double max_frame_ms = 0.0;
};

/// A fused frame further off than this is wrong.
inline constexpr double kWrong_m = 0.03;
/// Frames see the same place when their poses differ by less, in the terms of pose_error_m().
inline constexpr double kSamePlace_m = 0.5;
/// A view is good when so much of it has been fused before.
inline constexpr double kGoodViewShare = 0.5;

/// How far a pose moves what the camera sees: the displacement of the camera or of the point 1 m
/// before it, the larger one, metres.
double pose_error_m(const Pose& X_WC, const Pose& X_WC_reference);

/// Undamaged, its true place known, and at least half of its valid pixels show what was fused
/// before: a frame that a mapper ought to locate.
bool is_good(const FrameOutcome& outcome);

/// `X_WC_reference` by frame of the recording; located frames without a reference are not judged.
RecoveryMeasures measure(const std::vector<FrameOutcome>& outcomes,
                         const std::vector<std::optional<Pose>>& X_WC_reference,
                         const std::vector<std::optional<Pose>>& X_WC_true);

}  // namespace kintsugi::mapper::bench
