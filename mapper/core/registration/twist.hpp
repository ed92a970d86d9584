#pragma once
// Small motions of a camera as twists: (translation in metres, rotation vector in radians).

#include <Eigen/Core>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Directions of motion: each column a twist, columns independent; none to six.
using TwistBasis = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// The motion with the translation xi.head<3>() and the rotation exp(xi.tail<3>()). It is not the
/// exponential map of SE(3), whose translation depends on the rotation, but a retraction: it has
/// the same first derivative at zero.
Pose se3_retract(const Vector6d& xi);

/// Adjoint of X_AB: takes the twist of a left increment of X_BC to that of X_AC.
Matrix6d adjoint(const Pose& X_AB);

/// [p]x, the matrix of the cross product: [p]x q = p x q.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& p);

}  // namespace kintsugi::mapper
