#include "tests/bench/recovery_measures.hpp"

#include <algorithm>

#include "mapper/core/trajectory_error.hpp"

namespace kintsugi::mapper::bench {
namespace {

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

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
  measures.median_recovery_s = median_of(times_s);
  if (!times_s.empty()) measures.max_recovery_s = *std::max_element(times_s.begin(), times_s.end());
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
  return absolute_trajectory_error(estimate, truth).rmse_m;
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
  measures.median_frame_ms = median_of(times_ms);
  if (!times_ms.empty()) {
    measures.max_frame_ms = *std::max_element(times_ms.begin(), times_ms.end());
  }
  return measures;
}

}  // namespace kintsugi::mapper::bench
