#include "mapper/core/tracking/step_solver.hpp"

#include <Eigen/Cholesky>

namespace kintsugi::mapper {
namespace {

constexpr std::int64_t kMinInliers = 100;  ///< fewer pairs than this determine no pose worth having

/// x in the span of `basis` that minimises x' A x / 2 - b' x.
Vector6d solve_in(const TwistBasis& basis, const Matrix6d& A, const Vector6d& b) {
  if (basis.cols() == 0) return Vector6d::Zero();
  const Eigen::MatrixXd reduced = basis.transpose() * A * basis;
  return basis * reduced.ldlt().solve(basis.transpose() * b);
}

}  // namespace

void StepSolver::observe(const Information& geometric) {
  geometry_ = split_observable(geometric, Matrix6d::Identity(), config_.observability);
  undetermined_ = geometry_.open;
  photometric_information_.setZero();
  compared_share_ = 1.0;
  photometric_reliability_ = 1.0;
}

std::optional<Vector6d> StepSolver::solve(const NormalEquations& geometric, int level,
                                          const Pose& X_VC) {
  if (geometric.inliers < kMinInliers) return std::nullopt;
  Vector6d xi;
  if (geometry_.open.cols() == 0) {
    xi = geometric.A.ldlt().solve(geometric.b);
  } else {
    xi = solve_in(geometry_.determined, geometric.A, geometric.b);
    if (frame_ != nullptr && keyframe_ != nullptr) xi += photometric_part(xi, level, X_VC);
  }
  if (!xi.allFinite()) return std::nullopt;
  return xi;
}

Vector6d StepSolver::photometric_part(const Vector6d& geometric_part, int level, const Pose& X_VC) {
  const PhotometricImage image_C = frame_->level(level);
  const PhotometricEquations equations =
      linearize_photometric(image_C, keyframe_->view.level(level), X_VC,
                            keyframe_->X_WK.inverse() * X_WV_, exposure_, config_.photometric);
  const std::size_t pixels = image_C.surface.depth_m.total();
  const ObservableSplit split = split_observable(independent(equations.information, pixels),
                                                 geometry_.open, config_.observability);
  exposure_ = equations.exposure;
  undetermined_ = split.open;
  photometric_reliability_ = split.least_determined;
  photometric_information_ = equations.information.A;
  compared_share_ = static_cast<double>(equations.pixels) / static_cast<double>(pixels);
  return solve_in(split.determined, equations.information.A,
                  equations.b - equations.information.A * geometric_part);
}

}  // namespace kintsugi::mapper
