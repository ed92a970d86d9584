#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// Estimates the upward direction in W from the normals of the map.
///
/// W is the first camera pose (x right, y down, z forward), so -y of W is up only if the camera was
/// held level. Floors and table tops face up and ceilings face down, so up is the direction near -y
/// along which most normals lie: the mode of the normals (n and -n count alike) within kMaxTilt_rad
/// of -y, found by mean shift over bins on the sphere, from the bin with the most support. Up is -y
/// when less than kMinShare of the normals support it. The result depends on the points, not on the
/// order in which they were added.
class UpDirection {
 public:
  UpDirection() : bins_(std::size_t{kSide} * kSide, Eigen::Vector4d::Zero()) {}

  /// Adds the normals of points; points without a unit normal are ignored.
  void add(std::span<const CloudPoint> points_W);

  /// Subtracts normals that were added.
  void remove(std::span<const CloudPoint> points_W);

  /// Unit vector in W. Costs under a millisecond however many points were added, and nothing when
  /// none were since the last call.
  Eigen::Vector3d up_W() const;

  /// Whether enough of the normals support up_W(); else that is -y, whatever the points.
  bool is_supported() const;

 private:
  void count(std::span<const CloudPoint> points_W, double sign);
  std::optional<Eigen::Vector3d> estimate_W() const;

  static constexpr int kSide = 32;  ///< bins along one side of the unfolded octahedron
  static constexpr double kMaxTilt_rad =
      0.7854;                                ///< 45 degrees; beyond, a wall may be nearer to -y
  static constexpr double kMinShare = 0.05;  ///< of all normals

  std::vector<Eigen::Vector4d> bins_;  ///< sum of normals, and their number
  double total_ = 0.0;
  mutable bool is_estimated_ = false;            ///< of these bins
  mutable std::optional<Eigen::Vector3d> up_W_;  ///< if it is; nothing: without support
};

}  // namespace kintsugi
