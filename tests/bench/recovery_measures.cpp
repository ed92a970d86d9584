#include "tests/bench/recovery_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "segmenter/evaluation/trajectory/trajectory_error.hpp"

namespace kintsugi::mapper::bench {
namespace {

void measure_errors(const std::vector<FrameOutcome>& outcomes,
                    const std::vector<std::optional<Pose>>& X_WC_reference,
                    RecoveryMeasures& measures) {
  for (const FrameOutcome& outcome : outcomes) {
    const auto& reference = X_WC_reference.at(outcome.planned.frame);
    measures.located += outcome.located ? 1 : 0;
    if (outcome.located && outcome.part == 0 && reference) {
      const double error_m = pose_error_m(outcome.tracking.X_WC, *reference);
      measures.off += error_m > kWrong_m ? 1 : 0;
      measures.worst_error_m = std::max(measures.worst_error_m, error_m);
    }
    if (is_good(outcome)) {
      ++measures.good;
      measures.refused += outcome.located ? 0 : 1;
    }
  }
}

/// The pose at which a frame was fused, the part of the map, and its true pose.
struct Fused {
  int part;
  Pose X_WC;
  Pose X_WC_true;
};

/// Error of the frame relative to correctly fused frames of the same place: the smallest over all
/// within kSamePlace_m, or else that relative to the nearest one.
double misplacement_m(const Fused& frame, const std::vector<Fused>& right) {
  double least_m = std::numeric_limits<double>::infinity();
  double nearest_m = std::numeric_limits<double>::infinity();
  double by_nearest_m = 0.0;
  for (const Fused& other : right) {
    if (other.part != frame.part) continue;
    const double distance_m = pose_error_m(frame.X_WC_true, other.X_WC_true);
    const double error_m = pose_error_m(other.X_WC.inverse() * frame.X_WC,
                                        other.X_WC_true.inverse() * frame.X_WC_true);
    if (distance_m < kSamePlace_m) least_m = std::min(least_m, error_m);
    if (distance_m < nearest_m) {
      nearest_m = distance_m;
      by_nearest_m = error_m;
    }
  }
  return nearest_m < kSamePlace_m ? least_m : by_nearest_m;  // 0 for the first frame of a part
}

void measure_misplacement(const std::vector<FrameOutcome>& outcomes,
                          const std::vector<std::optional<Pose>>& X_WC_reference,
                          const std::vector<std::optional<Pose>>& X_WC_true,
                          RecoveryMeasures& measures) {
  const std::array paths = {&X_WC_reference, &X_WC_true};
  std::array<std::vector<Fused>, paths.size()> right;
  for (const FrameOutcome& outcome : outcomes) {
    if (!outcome.located) continue;
    double error_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const auto& X_WC = paths[i]->at(outcome.planned.frame);
      if (X_WC)
        error_m = std::min(error_m,
                           misplacement_m({outcome.part, outcome.tracking.X_WC, *X_WC}, right[i]));
    }
    if (std::isinf(error_m)) continue;  // the true pose of the frame is unknown
    measures.worst_misplacement_m = std::max(measures.worst_misplacement_m, error_m);
    measures.misplaced += error_m > kWrong_m ? 1 : 0;
    for (std::size_t i = 0; error_m <= kWrong_m && i < paths.size(); ++i) {
      const auto& X_WC = paths[i]->at(outcome.planned.frame);
      if (X_WC) right[i].push_back({outcome.part, outcome.tracking.X_WC, *X_WC});
    }
  }
}

void measure_recoveries(const std::vector<FrameOutcome>& outcomes, RecoveryMeasures& measures) {
  std::vector<double> times_s;
  std::optional<std::int64_t> first_good_us;
  for (const FrameOutcome& outcome : outcomes) {
    if (!outcome.located) {
      if (!first_good_us && is_good(outcome)) first_good_us = outcome.planned.utime;
    } else if (first_good_us) {
      times_s.push_back(1e-6 * static_cast<double>(outcome.planned.utime - *first_good_us));
      first_good_us.reset();
    }
  }
  measures.never_recovered = first_good_us ? 1 : 0;
  measures.recoveries = static_cast<int>(times_s.size());
  const ErrorStatistics statistics = statistics_of(times_s);
  measures.median_recovery_s = statistics.median;
  measures.max_recovery_s = statistics.max;
}

std::optional<double> ate_of(const std::vector<FrameOutcome>& outcomes,
                             const std::vector<std::optional<Pose>>& X_WC_true) {
  Trajectory estimate;
  Trajectory truth;
  for (const FrameOutcome& outcome : outcomes) {
    const auto& X_WC = X_WC_true.at(outcome.planned.frame);
    if (!outcome.located || outcome.part != 0 || !X_WC) continue;
    estimate.push_back({outcome.planned.utime, outcome.tracking.X_WC});
    truth.push_back({outcome.planned.utime, *X_WC});
  }
  if (estimate.size() < 3) return std::nullopt;
  return absolute_trajectory_error(estimate, truth).translation_m.rmse;
}

}  // namespace

double pose_error_m(const Pose& X_WC, const Pose& X_WC_reference) {
  const Eigen::Vector3d ahead_C = Eigen::Vector3d::UnitZ();
  return std::max((X_WC.translation() - X_WC_reference.translation()).norm(),
                  (X_WC * ahead_C - X_WC_reference * ahead_C).norm());
}

bool is_good(const FrameOutcome& outcome) {
  return outcome.planned.damage == Damage::kNone && outcome.view_known >= kGoodViewShare;
}

RecoveryMeasures measure(const std::vector<FrameOutcome>& outcomes,
                         const std::vector<std::optional<Pose>>& X_WC_reference,
                         const std::vector<std::optional<Pose>>& X_WC_true) {
  RecoveryMeasures measures;
  measures.frames = static_cast<int>(outcomes.size());
  std::set<int> parts;
  for (const FrameOutcome& outcome : outcomes) {
    if (outcome.located) parts.insert(outcome.part);
  }
  measures.parts = static_cast<int>(parts.size());
  measure_errors(outcomes, X_WC_reference, measures);
  measure_misplacement(outcomes, X_WC_reference, X_WC_true, measures);
  measure_recoveries(outcomes, measures);
  measures.ate_m = ate_of(outcomes, X_WC_true);
  std::vector<double> times_ms;
  times_ms.reserve(outcomes.size());
  for (const FrameOutcome& outcome : outcomes) times_ms.push_back(outcome.frame_ms);
  const ErrorStatistics statistics = statistics_of(times_ms);
  measures.median_frame_ms = statistics.median;
  measures.max_frame_ms = statistics.max;
  return measures;
}

}  // namespace kintsugi::mapper::bench
