#include "mapper/synthetic/rooms/walk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kintsugi::synthetic {

Walk::Walk(const Eigen::Vector3d& floor_W, double heading_deg, double pitch_deg)
    : floor_W_(floor_W), heading_deg_(heading_deg), pitch_deg_(pitch_deg) {
  append(floor_W, heading_deg, pitch_deg);
}

Walk& Walk::to(const Eigen::Vector3d& floor_W, double heading_deg, double pitch_deg) {
  constexpr double kLongestLeg_m = 0.8;
  constexpr double kLargestTurn_deg = 35.0;
  const double turn_deg = std::remainder(heading_deg - heading_deg_, 360.0);
  const double legs = std::max({1.0, std::ceil((floor_W - floor_W_).norm() / kLongestLeg_m),
                                std::ceil(std::abs(turn_deg) / kLargestTurn_deg)});
  const Eigen::Vector3d from_W = floor_W_;
  const double from_heading_deg = heading_deg_;
  const double from_pitch_deg = pitch_deg_;
  for (int leg = 1; leg <= static_cast<int>(legs); ++leg) {
    const double share = leg / legs;
    append(from_W + share * (floor_W - from_W), from_heading_deg + share * turn_deg,
           from_pitch_deg + share * (pitch_deg - from_pitch_deg));
  }
  floor_W_ = floor_W;
  heading_deg_ = from_heading_deg + turn_deg;
  pitch_deg_ = pitch_deg;
  return *this;
}

void Walk::append(const Eigen::Vector3d& floor_W, double heading_deg, double pitch_deg) {
  constexpr double kTargetDistance_m = 1.5;
  constexpr double kRadPerDeg = std::numbers::pi / 180.0;
  const double heading = heading_deg * kRadPerDeg;
  const double pitch = pitch_deg * kRadPerDeg;
  const Eigen::Vector3d view(std::cos(heading) * std::cos(pitch),
                             std::sin(heading) * std::cos(pitch), std::sin(pitch));
  const Eigen::Vector3d position_W = floor_W + kEyeHeight_m * Eigen::Vector3d::UnitZ();
  waypoints_.push_back({position_W, position_W + kTargetDistance_m * view});
}

}  // namespace kintsugi::synthetic
