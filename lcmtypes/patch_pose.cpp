#include "lcmtypes/patch_pose.hpp"

#include <cmath>

namespace kintsugi {

PatchPose::PatchPose(const Pose& X_WP) {
  Eigen::Quaterniond q(X_WP.linear());
  q.normalize();
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  for (int i = 0; i < 3; ++i) t_WP[i] = static_cast<float>(X_WP.translation()[i]);
  for (int i = 0; i < 4; ++i) q_WP[i] = static_cast<float>(q.coeffs()[i]);
}

// Written out, so that no library decides in which order the terms are added.
Pose PatchPose::pose() const {
  const double length = std::sqrt(
      ((double{q_WP[0]} * q_WP[0] + double{q_WP[1]} * q_WP[1]) + double{q_WP[2]} * q_WP[2]) +
      double{q_WP[3]} * q_WP[3]);
  const double x = q_WP[0] / length;
  const double y = q_WP[1] / length;
  const double z = q_WP[2] / length;
  const double w = q_WP[3] / length;
  Pose X_WP = Pose::Identity();
  X_WP.linear() << 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w),  //
      2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w),               //
      2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y);
  X_WP.translation() << t_WP[0], t_WP[1], t_WP[2];
  return X_WP;
}

bool PatchPose::is_identity() const {
  return t_WP[0] == 0.0F && t_WP[1] == 0.0F && t_WP[2] == 0.0F && q_WP[0] == 0.0F &&
         q_WP[1] == 0.0F && q_WP[2] == 0.0F;
}

}  // namespace kintsugi
