#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// Position and horizontal heading of the depth camera, low-pass filtered in map time (time
/// constant 1 s), so that a viewpoint that follows a hand-held camera does not shake.
class SmoothedCamera {
 public:
  /// Ignores poses that are not newer than the last one, or of a camera that is lost or starting.
  /// `up_W` is a unit vector.
  void update(const CameraPose& pose, const Eigen::Vector3d& up_W);

  bool has_pose() const { return utime_ > 0; }
  const Eigen::Vector3d& position_W() const { return position_W_; }  ///< metres
  const Eigen::Vector3d& heading_W() const { return heading_W_; }    ///< unit

 private:
  std::int64_t utime_ = 0;
  Eigen::Vector3d position_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d heading_W_ = Eigen::Vector3d::UnitZ();
};

}  // namespace kintsugi::viewer
