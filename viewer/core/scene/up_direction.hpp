#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// Where "up" is in W, from the normals of the map.
///
/// W is the first camera pose (x right, y down, z forward), so -y of W is up only as far as the
/// camera was held level. Floors and table tops face up and ceilings face down: the direction
/// nearest to -y along which most normals lie is up. The normals are summed in bins over the
/// sphere, n and -n together, and up is the mean shift over the bins from their fullest place
/// within kMaxTilt_rad of -y. With too few points there, or none, up is -y. It depends on which
/// points are there, not on the order in which they came.
class UpDirection {
 public:
  UpDirection() : bins_(std::size_t{kSide} * kSide, Eigen::Vector4d::Zero()) {}

  /// Adds the normals of points; those without a unit normal are passed over.
  void add(std::span<const CloudPoint> points_W);

  /// Takes back normals that were added.
  void remove(std::span<const CloudPoint> points_W);

  /// Unit vector in W. Costs under a millisecond however many points were added.
  Eigen::Vector3d up_W() const;

 private:
  void count(std::span<const CloudPoint> points_W, double sign);

  static constexpr int kSide = 32;  ///< bins along one side of the unfolded octahedron
  static constexpr double kMaxTilt_rad = 0.7854;  ///< beyond 45 degrees a wall may be nearer to -y
  static constexpr double kMinShare = 0.05;       ///< of all normals that must support up

  std::vector<Eigen::Vector4d> bins_;  ///< sum of normals, and their number
  double total_ = 0.0;
};

}  // namespace kintsugi::viewer
