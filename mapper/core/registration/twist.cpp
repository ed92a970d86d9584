#include "mapper/core/registration/twist.hpp"

namespace kintsugi::mapper {

Pose se3_retract(const Vector6d& xi) {
  Pose X = Pose::Identity();
  X.translation() = xi.head<3>();
  const double angle_rad = xi.tail<3>().norm();
  if (angle_rad > 1e-12) {
    X.linear() = Eigen::AngleAxisd(angle_rad, xi.tail<3>() / angle_rad).toRotationMatrix();
  }
  return X;
}

Matrix6d adjoint(const Pose& X_AB) {
  Matrix6d Ad = Matrix6d::Zero();
  Ad.topLeftCorner<3, 3>() = Ad.bottomRightCorner<3, 3>() = X_AB.linear();
  Ad.topRightCorner<3, 3>() = cross_matrix(X_AB.translation()) * X_AB.linear();
  return Ad;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& p) {
  Eigen::Matrix3d matrix;
  matrix << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0;
  return matrix;
}

}  // namespace kintsugi::mapper
