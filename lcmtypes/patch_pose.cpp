#include "lcmtypes/patch_pose.hpp"

#include <algorithm>
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
  const double unit = length();
  const double x = q_WP[0] / unit;
  const double y = q_WP[1] / unit;
  const double z = q_WP[2] / unit;
  const double w = q_WP[3] / unit;
  Pose X_WP = Pose::Identity();
  X_WP.linear() << 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w),  //
      2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w),               //
      2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y);
  X_WP.translation() << t_WP[0], t_WP[1], t_WP[2];
  return X_WP;
}

double PatchPose::length() const {
  double squared = 0.0;
  for (const double q : q_WP) squared += q * q;
  return std::sqrt(squared);
}

bool PatchPose::is_valid() const {
  // Written so that NaN is not valid.
  return std::ranges::all_of(t_WP, [](double t) { return std::abs(t) <= kMaxPosition_m; }) &&
         std::abs(length() - 1.0) <= kUnitTolerance;
}

bool PatchPose::is_identity() const {
  return t_WP[0] == 0.0F && t_WP[1] == 0.0F && t_WP[2] == 0.0F && q_WP[0] == 0.0F &&
         q_WP[1] == 0.0F && q_WP[2] == 0.0F;
}

}  // namespace kintsugi
