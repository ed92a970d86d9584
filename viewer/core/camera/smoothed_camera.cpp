#include "viewer/core/camera/smoothed_camera.hpp"

#include <algorithm>
#include <cmath>

namespace kintsugi::viewer {

void SmoothedCamera::update(const CameraPose& pose, const Eigen::Vector3d& up_W) {
  if (!is_located(pose.state)) return;
  if (has_pose() && pose.utime <= utime_) return;
  constexpr double kTimeConstant_s = 1.0;
  const Eigen::Vector3d position_W = pose.X_WC.translation();
  const Eigen::Vector3d forward_W = pose.X_WC.linear().col(2);
  Eigen::Vector3d heading_W = forward_W - forward_W.dot(up_W) * up_W;

  const bool first = !has_pose();
  const double elapsed_s = 1e-6 * static_cast<double>(pose.utime - utime_);
  const double gain = first ? 1.0 : 1.0 - std::exp(-elapsed_s / kTimeConstant_s);
  utime_ = std::max<std::int64_t>(pose.utime, 1);
  position_W_ += gain * (position_W - position_W_);
  if (heading_W.norm() < 0.1) return;  // looks almost straight up or down: heading is undefined
  heading_W.normalize();
  const Eigen::Vector3d turned_W = heading_W_ + gain * (heading_W - heading_W_);
  heading_W_ = turned_W.norm() > 1e-3 ? Eigen::Vector3d(turned_W.normalized()) : heading_W;
}

}  // namespace kintsugi::viewer
