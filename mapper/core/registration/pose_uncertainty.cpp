#include "mapper/core/registration/pose_uncertainty.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace kintsugi::mapper {
double pose_sigma_m(const Matrix6d& A, const Pose& X_VC, int num_pixels) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(A);
  const Vector6d& information = solver.eigenvalues();
  // Zero except for rounding.
  if (!(information(0) > 1e-12 * information(5))) return std::numeric_limits<double>::infinity();
  const Matrix6d covariance = solver.eigenvectors() * information.cwiseInverse().asDiagonal() *
                              solver.eigenvectors().transpose();
  double worst_m2 = 0.0;
  for (const Eigen::Vector3d& p_V :
       {Eigen::Vector3d(X_VC.translation()), Eigen::Vector3d(X_VC * Eigen::Vector3d::UnitZ())}) {
    Eigen::Matrix<double, 3, 6> J;
    J << Eigen::Matrix3d::Identity(), -cross_matrix(p_V);
    const Eigen::Matrix3d spread = J * covariance * J.transpose();
    worst_m2 = std::max(
        worst_m2, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly)
                      .eigenvalues()(2));
  }
  return std::sqrt(worst_m2 * static_cast<double>(num_pixels) / kIndependentPatches);
}

Matrix6d information_of_pose(const Matrix6d& A, const Pose& X_VC, int num_pixels) {
  const Matrix6d to_V = adjoint(X_VC);
  const Matrix6d information = to_V.transpose() * A * to_V;
  // Symmetric but for rounding.
  return (0.5 * kIndependentPatches / num_pixels) * (information + information.transpose());
}

}  // namespace kintsugi::mapper
