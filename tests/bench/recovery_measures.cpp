#include "tests/bench/recovery_measures.hpp"

#include <algorithm>

#include "lcmtypes/trajectory_error.hpp"

namespace kintsugi::mapper::bench {
namespace {

void measure_errors(const std::vector<FrameOutcome>& outcomes,
                    const std::vector<std::optional<Pose>>& X_WC_reference,
                    RecoveryMeasures& measures) {
  for (const FrameOutcome& outcome : outcomes) {
    const auto& reference = X_WC_reference.at(outcome.planned.frame);
    measures.located += outcome.located ? 1 : 0;
    if (outcome.located && reference) {
      const double error_m = pose_error_m(outcome.tracking.X_WC, *reference);
      measures.wrong += error_m > kWrong_m ? 1 : 0;
      measures.worst_error_m = std::max(measures.worst_error_m, error_m);
    }
    if (is_good(outcome)) {
      ++measures.good;
      measures.refused += outcome.located ? 0 : 1;
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
    if (!outcome.located || !X_WC) continue;
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
  measure_errors(outcomes, X_WC_reference, measures);
  measure_recoveries(outcomes, measures);
  measures.ate_m = ate_of(outcomes, X_WC_true);
  std::vector<double> times_ms;
  for (const FrameOutcome& outcome : outcomes) times_ms.push_back(outcome.frame_ms);
  const ErrorStatistics statistics = statistics_of(times_ms);
  measures.median_frame_ms = statistics.median;
  measures.max_frame_ms = statistics.max;
  return measures;
}

}  // namespace kintsugi::mapper::bench
