#pragma once
// Sums of information over the pixels of an image.

#include <Eigen/Core>

#include "mapper/core/registration/twist.hpp"

namespace kintsugi::mapper {

using Vector6f = Eigen::Matrix<float, 6, 1>;
using Matrix6f = Eigen::Matrix<float, 6, 6>;

/// The information of a registration on the motion of the camera; observability.hpp defines A and
/// C.
struct Information {
  Matrix6d A = Matrix6d::Zero();
  Matrix6d C = Matrix6d::Zero();
};

/// The row of a Jacobian for the left increment of a pose: `a` is the derivative of the measurement
/// with respect to the moved point `p`.
inline Vector6f increment_row(const Eigen::Vector3f& a, const Eigen::Vector3f& p) {
  const Eigen::Vector3f moment = p.cross(a);
  Vector6f row;
  row << a.x(), a.y(), a.z(), moment.x(), moment.y(), moment.z();
  return row;
}

/// Information of the pairs of a band of rows, in single precision.
struct InformationSum {
  Matrix6f A = Matrix6f::Zero();
  Matrix6f C = Matrix6f::Zero();  ///< not yet symmetric

  void add(const Vector6f& row, const Vector6f& other_row, float weight) {
    const Vector6f weighted = weight * row;
    A.noalias() += weighted * row.transpose();
    C.noalias() += weighted * other_row.transpose();
  }
  void add_to(Information& total) const {
    total.A += A.cast<double>();
    const Matrix6d half = 0.5 * C.cast<double>();
    total.C += half + half.transpose();
  }
};

}  // namespace kintsugi::mapper
