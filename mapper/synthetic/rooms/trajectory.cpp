#include "mapper/synthetic/rooms/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/Splines>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/synthetic/scene/counter_random.hpp"

namespace kintsugi::synthetic {

namespace {

constexpr int kKnotsPerFrame = 4;
constexpr double kSmoothing_s = 0.5;  // the speed changes over about this time

using WaypointSpline = Eigen::Spline<double, 6>;  // position, target

WaypointSpline fit(const std::vector<Waypoint>& waypoints) {
  const auto count = static_cast<Eigen::Index>(waypoints.size());
  Eigen::Matrix<double, 6, Eigen::Dynamic> points(6, count);
  Eigen::RowVectorXd parameters(count);  // centripetal: no loops or cusps at uneven waypoints
  double length = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    points.col(i) << waypoints[i].position_W, waypoints[i].target_W;
    if (i > 0) length += std::max(1e-3, std::sqrt((points.col(i) - points.col(i - 1)).norm()));
    parameters[i] = length;
  }
  parameters /= length;
  return Eigen::SplineFitting<WaypointSpline>::Interpolate(
      points, std::min<Eigen::Index>(3, count - 1), parameters);
}

/// Mean over 2 * reach + 1 values, fewer at the ends.
std::vector<double> moving_average(const std::vector<double>& values, int reach) {
  std::vector<double> sums(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
  std::vector<double> means(values.size());
  const int count = static_cast<int>(values.size());
  for (int i = 0; i < count; ++i) {
    const int symmetric = std::min({reach, i, count - 1 - i});
    means[i] = (sums[i + symmetric + 1] - sums[i - symmetric]) / (2 * symmetric + 1);
  }
  return means;
}

}  // namespace

Pose look_at(const Eigen::Vector3d& position_W, const Eigen::Vector3d& target_W) {
  const Eigen::Vector3d forward = (target_W - position_W).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ());
  if (!(right.norm() > 1e-6)) {
    throw std::invalid_argument(
        "look_at: the target must not coincide with the position nor be straight above or below "
        "it");
  }
  Pose X_WC = Pose::Identity();
  X_WC.linear().col(0) = right.normalized();
  X_WC.linear().col(2) = forward;
  X_WC.linear().col(1) = forward.cross(X_WC.linear().col(0));
  X_WC.translation() = position_W;
  return X_WC;
}

std::int64_t frame_utime(std::int64_t frame_index) {
  return (frame_index * 1'000'000 + kFrameRate_hz / 2) / kFrameRate_hz;
}

void Trajectory::Config::validate() const {
  require(std::isfinite(duration_s) && duration_s > 0, "duration_s", duration_s,
          "a finite value above 0");
  require(turn_m_per_rad >= 0, "turn_m_per_rad", turn_m_per_rad, "at least 0");
  require(shake_position_m >= 0, "shake_position_m", shake_position_m, "at least 0");
  require(shake_orientation_rad >= 0, "shake_orientation_rad", shake_orientation_rad, "at least 0");
}

Trajectory::Trajectory(const std::vector<Waypoint>& waypoints, const Config& config)
    : config_(config) {
  config_.validate();
  require(waypoints.size() >= 2, "number of waypoints", waypoints.size(), "at least 2");
  sample_splines(waypoints);
  assign_times();
  CounterRandom random(config_.seed);
  for (int axis = 0; axis < 6; ++axis) {
    const double amplitude = axis < 3 ? config_.shake_position_m : config_.shake_orientation_rad;
    for (int i = 0; i < kSinesPerAxis; ++i) {
      const double frequency_hz = random.uniform(0.3, 2.5);
      // A hand's shake falls off with frequency: equal speed in each sine above 1 Hz.
      sines_.push_back({amplitude / std::max(1.0, frequency_hz),
                        2.0 * std::numbers::pi * frequency_hz,
                        random.uniform(0.0, 2.0 * std::numbers::pi)});
    }
  }
}

void Trajectory::sample_splines(const std::vector<Waypoint>& waypoints) {
  const WaypointSpline spline = fit(waypoints);
  const int count = std::max(1000, kKnotsPerFrame * num_frames());
  knots_.reserve(count);
  for (int i = 0; i < count; ++i) {
    const Eigen::Matrix<double, 6, 1> point = spline(static_cast<double>(i) / (count - 1));
    const Pose X_WC = look_at(point.head<3>(), point.tail<3>());
    knots_.push_back({0.0, X_WC.translation(), Eigen::Quaterniond(X_WC.linear())});
  }
}

/// Time passes along the path in proportion to the distance gone and the angle turned, smoothed.
void Trajectory::assign_times() {
  std::vector<double> steps;
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const double distance_m = (knots_[i].position_W - knots_[i - 1].position_W).norm();
    const double turn_rad = knots_[i].q_WC.angularDistance(knots_[i - 1].q_WC);
    length_m_ += distance_m;
    steps.push_back(distance_m + config_.turn_m_per_rad * turn_rad);
  }
  const auto reach = static_cast<int>(0.5 * kSmoothing_s / config_.duration_s * steps.size());
  steps = moving_average(moving_average(steps, reach), reach);
  double total = 0.0;
  for (double step : steps) total += step;
  require(total > 0.0, "path", total, "one that moves or turns");
  double t_s = 0.0;
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    t_s += steps[i - 1] * config_.duration_s / total;
    knots_[i].t_s = t_s;
  }
}

int Trajectory::num_frames() const {
  return 1 + static_cast<int>(std::floor(config_.duration_s * kFrameRate_hz + 1e-9));
}

double Trajectory::shake(int axis, double t_s) const {
  double sum = 0.0;
  for (int i = 0; i < kSinesPerAxis; ++i) {
    const Sine& sine = sines_[axis * kSinesPerAxis + i];
    sum += sine.amplitude * std::sin(sine.rad_per_s * t_s + sine.phase_rad);
  }
  return sum;
}

bool Trajectory::is_closed() const {
  constexpr double kMost = 0.01;  // metres and radians: less than the shake of the hand
  const Knot& first = knots_.front();
  const Knot& last = knots_.back();
  return (first.position_W - last.position_W).norm() < kMost &&
         first.q_WC.angularDistance(last.q_WC) < kMost;
}

Pose Trajectory::X_WC(double t_s, int laps) const {
  const double lap_s = knots_.back().t_s;
  const double since_start_s = std::clamp(t_s, 0.0, laps * lap_s);
  const double lap = std::min(std::floor(since_start_s / lap_s), laps - 1.0);
  const double t = since_start_s - lap * lap_s;
  const auto after =
      std::clamp(std::lower_bound(knots_.begin(), knots_.end(), t,
                                  [](const Knot& knot, double time) { return knot.t_s < time; }),
                 knots_.begin() + 1, knots_.end() - 1);
  const Knot& a = *(after - 1);
  const Knot& b = *after;
  const double share = b.t_s > a.t_s ? (t - a.t_s) / (b.t_s - a.t_s) : 0.0;
  const Eigen::Vector3d turn_C(shake(3, since_start_s), shake(4, since_start_s),
                               shake(5, since_start_s));
  Pose X_WC = Pose::Identity();
  X_WC.translation() =
      a.position_W + share * (b.position_W - a.position_W) +
      Eigen::Vector3d(shake(0, since_start_s), shake(1, since_start_s), shake(2, since_start_s));
  X_WC.linear() =
      (a.q_WC.slerp(share, b.q_WC) * Eigen::AngleAxisd(turn_C.norm(), turn_C.stableNormalized()))
          .toRotationMatrix();
  return X_WC;
}

}  // namespace kintsugi::synthetic
