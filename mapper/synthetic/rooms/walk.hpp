#pragma once
// A camera path given by places and headings.

#include <Eigen/Core>
#include <vector>

#include "mapper/synthetic/rooms/trajectory.hpp"

namespace kintsugi::synthetic {

/// A walk with the camera at eye height: from place to place, looking along a heading (degrees in
/// the plane, 0 along W's x, 90 along y) and slightly down. Long legs and large turns get points in
/// between, so that the splines of Trajectory stay near the straight line.
class Walk {
 public:
  /// @param floor_W point on the floor below the camera
  Walk(const Eigen::Vector3d& floor_W, double heading_deg, double pitch_deg = kPitch_deg);

  /// Moves to another place; turns by the smaller of the two angles.
  Walk& to(const Eigen::Vector3d& floor_W, double heading_deg, double pitch_deg = kPitch_deg);

  const std::vector<Waypoint>& waypoints() const { return waypoints_; }

  static constexpr double kEyeHeight_m = 1.40;
  static constexpr double kPitch_deg = -24.0;

 private:
  void append(const Eigen::Vector3d& floor_W, double heading_deg, double pitch_deg);

  std::vector<Waypoint> waypoints_;
  Eigen::Vector3d floor_W_;
  double heading_deg_;
  double pitch_deg_;
};

}  // namespace kintsugi::synthetic
