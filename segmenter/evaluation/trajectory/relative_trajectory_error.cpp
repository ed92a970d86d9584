#include "segmenter/evaluation/trajectory/relative_trajectory_error.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kintsugi {
namespace {

using Motion = std::pair<std::size_t, std::size_t>;  // from and to, indices into the estimate

constexpr std::uint64_t kSeed = 1;

/// The index of the value nearest to `target`, by the bisection of the benchmark's tools: it
/// decides which of several equally near ones that is.
std::size_t nearest_index(const std::vector<double>& ascending, double target) {
  std::size_t best = 0;
  std::size_t begin = 0;
  std::size_t end = ascending.size();
  while (begin < end) {
    const std::size_t middle = (begin + end) / 2;
    if (std::abs(ascending[middle] - target) < std::abs(ascending[best] - target)) best = middle;
    if (ascending[middle] == target) return middle;
    if (ascending[middle] > target) {
      end = middle;
    } else {
      begin = middle + 1;
    }
  }
  return best;
}

std::vector<double> times_us(const Trajectory& trajectory, std::int64_t start_us) {
  std::vector<double> times;
  for (const StampedPose& pose : trajectory) {
    times.push_back(static_cast<double>(pose.utime - start_us));
  }
  return times;
}

/// The distance from a pose to the next, in `unit`.
double step_between(const StampedPose& pose, const StampedPose& next, DeltaUnit unit) {
  const Pose motion = pose.X_WC.inverse() * next.X_WC;
  switch (unit) {
    case DeltaUnit::kSeconds:
      return 1e-6 * static_cast<double>(next.utime - pose.utime);
    case DeltaUnit::kFrames:
      return 1.0;
    case DeltaUnit::kMetres:
      return motion.translation().norm();
    case DeltaUnit::kDegrees:
      return rotation_angle_rad(motion) * 180.0 / M_PI;
  }
  return 0.0;
}

/// The distance of each pose from the first along the trajectory, in `unit`.
std::vector<double> progress_along(const Trajectory& trajectory, DeltaUnit unit) {
  std::vector<double> progress = {0.0};
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    progress.push_back(progress.back() + step_between(trajectory[i - 1], trajectory[i], unit));
  }
  return progress;
}

std::vector<Motion> fixed_motions(const Trajectory& estimate,
                                  const RelativeTrajectoryErrorConfig& config) {
  const std::vector<double> progress = progress_along(estimate, config.delta_unit);
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < progress.size(); ++i) {
    const std::size_t j = nearest_index(progress, progress[i] + config.delta);
    if (j + 1 != progress.size()) motions.emplace_back(i, j);
  }
  return motions;
}

std::vector<Motion> all_motions(std::size_t num_poses, std::size_t max_pairs) {
  std::vector<Motion> motions;
  if (num_poses <= max_pairs / num_poses) {
    for (std::size_t i = 0; i < num_poses; ++i) {
      for (std::size_t j = 0; j < num_poses; ++j) motions.emplace_back(i, j);
    }
    return motions;
  }
  std::mt19937_64 random(kSeed);  // its numbers are the same everywhere, unlike a distribution's
  for (std::size_t n = 0; n < max_pairs; ++n) {
    const std::size_t from = random() % num_poses;
    motions.emplace_back(from, random() % num_poses);
  }
  return motions;
}

double median_interval_us(const Trajectory& trajectory) {
  std::vector<double> intervals_us;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    intervals_us.push_back(static_cast<double>(trajectory[i].utime - trajectory[i - 1].utime));
  }
  return statistics_of(std::move(intervals_us)).median;
}

/// The true pose nearest in time to each estimated pose, if it is near enough.
std::vector<const Pose*> true_poses(const Trajectory& estimate, const Trajectory& truth) {
  const std::int64_t start_us = truth.front().utime;
  const std::vector<double> truth_us = times_us(truth, start_us);
  const double max_difference_us = 2.0 * median_interval_us(truth);
  std::vector<const Pose*> poses;
  for (const double time_us : times_us(estimate, start_us)) {
    const std::size_t nearest = nearest_index(truth_us, time_us);
    const bool is_near = std::abs(truth_us[nearest] - time_us) <= max_difference_us;
    poses.push_back(is_near ? &truth[nearest].X_WC : nullptr);
  }
  return poses;
}

}  // namespace

void RelativeTrajectoryErrorConfig::validate() const {
  if (!(delta > 0.0) || !std::isfinite(delta)) {
    throw std::invalid_argument("delta is " + std::to_string(delta) +
                                ", must be positive and finite");
  }
  if (max_pairs == 0) throw std::invalid_argument("max_pairs is 0, must be at least 1");
}

RelativeTrajectoryError relative_trajectory_error(const Trajectory& estimate,
                                                  const Trajectory& truth,
                                                  const RelativeTrajectoryErrorConfig& config) {
  config.validate();
  if (estimate.size() < 2 || truth.size() < 2) {
    throw std::invalid_argument("relative trajectory error: estimate and truth have " +
                                std::to_string(estimate.size()) + " and " +
                                std::to_string(truth.size()) + " poses, need at least 2 each");
  }
  const std::vector<const Pose*> actual = true_poses(estimate, truth);
  std::vector<double> translations_m;
  std::vector<double> rotations_rad;
  for (const auto& [from, to] : config.fixed_delta
                                    ? fixed_motions(estimate, config)
                                    : all_motions(estimate.size(), config.max_pairs)) {
    if (actual[from] == nullptr || actual[to] == nullptr) continue;
    const Pose estimated_motion = estimate[to].X_WC.inverse() * estimate[from].X_WC;
    const Pose actual_motion = actual[to]->inverse() * *actual[from];
    const Pose error = estimated_motion.inverse() * actual_motion;
    translations_m.push_back(error.translation().norm());
    rotations_rad.push_back(rotation_angle_rad(error));
  }
  if (translations_m.size() < 2) {
    throw std::invalid_argument(
        "relative trajectory error: " + std::to_string(translations_m.size()) +
        " motions over the given delta have a true one, need at least 2");
  }
  return {statistics_of(std::move(translations_m)), statistics_of(std::move(rotations_rad))};
}

}  // namespace kintsugi
