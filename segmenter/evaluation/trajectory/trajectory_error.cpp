#include "segmenter/evaluation/trajectory/trajectory_error.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <queue>
#include <stdexcept>
#include <tuple>

namespace kintsugi {
namespace {

/// Poses of both trajectories in order of time, as a list from which pairs are taken out.
///
/// The two that are nearest of all that are left are neighbours in it: a pose between them would be
/// nearer to one of them. So only neighbours are ever compared.
class Associator {
 public:
  Associator(const Trajectory& estimate, const Trajectory& truth, std::int64_t max_difference_us)
      : estimate_(estimate), truth_(truth), max_difference_us_(max_difference_us) {
    merge();
    for (std::size_t i = 0; i + 1 < poses_.size(); ++i) consider(i, i + 1);
  }

  std::vector<PosePair> take_pairs() {
    std::vector<PosePair> pairs;
    while (!candidates_.empty()) {
      const auto [difference_us, truth_utime, estimate_utime, left, right] = candidates_.top();
      candidates_.pop();
      if (poses_[left].is_taken || poses_[right].is_taken) continue;
      pairs.push_back(take(left, right));
    }
    std::sort(pairs.begin(), pairs.end(),
              [](const PosePair& a, const PosePair& b) { return a.truth < b.truth; });
    return pairs;
  }

 private:
  struct TimedPose {
    std::int64_t utime = 0;
    std::size_t index = 0;  ///< in its trajectory
    bool is_true = false;
    bool is_taken = false;
    std::optional<std::size_t> before = std::nullopt;
    std::optional<std::size_t> after = std::nullopt;
  };
  /// Difference, time of the true pose, time of the estimate, and the two neighbours.
  using Candidate = std::tuple<std::int64_t, std::int64_t, std::int64_t, std::size_t, std::size_t>;

  void merge() {
    for (std::size_t i = 0; i < truth_.size(); ++i) poses_.push_back({truth_[i].utime, i, true});
    for (std::size_t i = 0; i < estimate_.size(); ++i) poses_.push_back({estimate_[i].utime, i});
    std::stable_sort(poses_.begin(), poses_.end(),
                     [](const TimedPose& a, const TimedPose& b) { return a.utime < b.utime; });
    for (std::size_t i = 0; i + 1 < poses_.size(); ++i) {
      poses_[i].after = i + 1;
      poses_[i + 1].before = i;
    }
  }

  void consider(std::size_t left, std::size_t right) {
    const TimedPose& a = poses_[left];
    const TimedPose& b = poses_[right];
    const std::int64_t difference_us = b.utime - a.utime;
    if (a.is_true == b.is_true || difference_us >= max_difference_us_) return;
    candidates_.emplace(difference_us, a.is_true ? a.utime : b.utime, a.is_true ? b.utime : a.utime,
                        left, right);
  }

  PosePair take(std::size_t left, std::size_t right) {
    TimedPose& a = poses_[left];
    TimedPose& b = poses_[right];
    a.is_taken = b.is_taken = true;
    if (a.before) poses_[*a.before].after = b.after;
    if (b.after) poses_[*b.after].before = a.before;
    if (a.before && b.after) consider(*a.before, *b.after);
    return a.is_true ? PosePair{b.index, a.index} : PosePair{a.index, b.index};
  }

  const Trajectory& estimate_;
  const Trajectory& truth_;
  const std::int64_t max_difference_us_;
  std::vector<TimedPose> poses_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates_;
};

std::vector<PosePair> enough_pairs(const Trajectory& estimate, const Trajectory& truth) {
  auto pairs = associate(estimate, truth);
  if (pairs.size() < 3) {
    throw std::invalid_argument("trajectory error: " + std::to_string(pairs.size()) +
                                " poses have a true pose within 20 ms, expected at least 3");
  }
  return pairs;
}

}  // namespace

ErrorStatistics statistics_of(std::vector<double> errors) {
  ErrorStatistics statistics;
  if (errors.empty()) return statistics;
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  const double squares = std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
  statistics.count = errors.size();
  statistics.rmse = std::sqrt(squares / count);
  statistics.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
  statistics.median = 0.5 * (errors[(errors.size() - 1) / 2] + errors[errors.size() / 2]);
  double variance = 0.0;
  for (const double error : errors) variance += std::pow(error - statistics.mean, 2) / count;
  statistics.std = std::sqrt(variance);
  statistics.min = errors.front();
  statistics.max = errors.back();
  return statistics;
}

std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth,
                                std::int64_t max_difference_us) {
  return Associator(estimate, truth, max_difference_us).take_pairs();
}

AbsoluteTrajectoryError absolute_trajectory_error(const Trajectory& estimate,
                                                  const Trajectory& truth) {
  const auto pairs = enough_pairs(estimate, truth);
  const auto count = static_cast<Eigen::Index>(pairs.size());
  Eigen::Matrix3Xd estimated_W(3, count);
  Eigen::Matrix3Xd actual_T(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const PosePair& pair = pairs[static_cast<std::size_t>(i)];
    estimated_W.col(i) = estimate[pair.estimate].X_WC.translation();
    actual_T.col(i) = truth[pair.truth].X_WC.translation();
  }
  AbsoluteTrajectoryError result;
  result.X_TW = Pose(Eigen::umeyama(estimated_W, actual_T, false));
  std::vector<double> errors_m;
  errors_m.reserve(pairs.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    errors_m.push_back((result.X_TW * estimated_W.col(i) - actual_T.col(i)).norm());
  }
  result.translation_m = statistics_of(std::move(errors_m));
  return result;
}

double PathDrift::percent() const {
  return path_length_m > 0.0 ? 100.0 * end_translation_m / path_length_m : 0.0;
}

PathDrift path_drift(const Trajectory& estimate, const Trajectory& truth) {
  const auto pairs = enough_pairs(estimate, truth);
  PathDrift drift;
  drift.num_pairs = pairs.size();
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    drift.path_length_m +=
        (truth[pairs[i].truth].X_WC.translation() - truth[pairs[i - 1].truth].X_WC.translation())
            .norm();
  }
  const Pose X_TW =
      truth[pairs.front().truth].X_WC * estimate[pairs.front().estimate].X_WC.inverse();
  const Pose end_error =
      truth[pairs.back().truth].X_WC.inverse() * X_TW * estimate[pairs.back().estimate].X_WC;
  drift.end_translation_m = end_error.translation().norm();
  drift.end_rotation_rad = rotation_angle_rad(end_error);
  return drift;
}

}  // namespace kintsugi
