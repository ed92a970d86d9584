#pragma once
// Errors of a disturbed run: wrong poses, refused frames, and the time until a lost camera is
// found.

#include <optional>
#include <vector>

#include "tests/bench/recovery_run.hpp"

namespace kintsugi::mapper::bench {

struct RecoveryMeasures {
  int frames = 0;
  int located = 0;
  /// Frames fused wrongly: more than kWrong_m from where correctly fused frames of the same place
  /// put them. Drift over a long path does not count. For a recording neither the reference nor the
  /// truth is exact, so a frame counts only if it is wrong by both. Frames are compared with those
  /// of the same part of the map.
  int misplaced = 0;
  double worst_misplacement_m = 0.0;
  int parts = 0;                   ///< of the map, that no loop has joined in the end
  int off = 0;                     ///< in part 0, more than kWrong_m off the reference, with drift
  double worst_error_m = 0.0;      ///< of the located frames, against the reference
  int good = 0;                    ///< see is_good()
  int refused = 0;                 ///< good but not located
  int recoveries = 0;              ///< losses with a good frame that ended
  int never_recovered = 0;         ///< losses with a good frame that did not end
  double median_recovery_s = 0.0;  ///< from the first good frame of a loss to its end
  double max_recovery_s = 0.0;
  std::optional<double> ate_m;  ///< RMSE after alignment with the truth of the recording
  double median_frame_ms = 0.0;
  double max_frame_ms = 0.0;
};

/// A frame fused farther off than this is wrong.
inline constexpr double kWrong_m = 0.03;
/// Two frames show the same place if pose_error_m() of their poses is smaller than this.
inline constexpr double kSamePlace_m = 0.5;
/// A view is good if at least this share of it was fused before.
inline constexpr double kGoodViewShare = 0.5;

/// Difference of two poses: the distance between the camera positions or between the points 1 m in
/// front of the camera, whichever is larger, metres.
double pose_error_m(const Pose& X_WC, const Pose& X_WC_reference);

/// Whether a mapper should locate the frame: it is undamaged, its true pose is known, and at least
/// kGoodViewShare of its valid pixels show what was fused before.
bool is_good(const FrameOutcome& outcome);

/// `X_WC_reference` is indexed by frame of the recording; frames without a reference are ignored.
RecoveryMeasures measure(const std::vector<FrameOutcome>& outcomes,
                         const std::vector<std::optional<Pose>>& X_WC_reference,
                         const std::vector<std::optional<Pose>>& X_WC_true);

}  // namespace kintsugi::mapper::bench
