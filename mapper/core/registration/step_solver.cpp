#include "mapper/core/registration/step_solver.hpp"

#include <Eigen/Cholesky>

namespace kintsugi::mapper {
namespace {

constexpr std::int64_t kMinInliers = 100;  ///< fewer pairs do not give a usable pose

/// x in the span of `basis` that minimises x' A x / 2 - b' x.
Vector6d solve_in(const TwistBasis& basis, const Matrix6d& A, const Vector6d& b) {
  if (basis.cols() == 0) return Vector6d::Zero();
  const Eigen::MatrixXd reduced = basis.transpose() * A * basis;
  return basis * reduced.ldlt().solve(basis.transpose() * b);
}

}  // namespace

void StepSolver::observe(const Information& geometric) {
  geometry_ = split_observable(geometric, Matrix6d::Identity(), config_.observability);
}

std::optional<Step> StepSolver::solve(const NormalEquations& geometric, int level,
                                      const Pose& X_VC) {
  if (geometric.inliers < kMinInliers) return std::nullopt;
  Step step;
  step.undetermined = geometry_.open;
  if (geometry_.open.cols() == 0) {
    step.xi = geometric.A.ldlt().solve(geometric.b);
  } else {
    step.xi = solve_in(geometry_.determined, geometric.A, geometric.b);
    if (colors_.frame_C != nullptr && colors_.reference != nullptr) {
      add_photometric_part(level, X_VC, step);
    }
  }
  if (!step.xi.allFinite()) return std::nullopt;
  return step;
}

void StepSolver::add_photometric_part(int level, const Pose& X_VC, Step& step) {
  const PhotometricImage image_C = colors_.frame_C->level(level);
  PhotometricReference& reference = *colors_.reference;
  const PhotometricEquations equations =
      linearize_photometric(image_C, reference.frame_K.level(level), X_VC,
                            reference.X_WK.inverse() * X_WV_, exposure_, config_.photometric);
  const std::size_t pixels = image_C.surface.depth_m.total();
  const ObservableSplit split = split_observable(independent(equations.information, pixels),
                                                 geometry_.open, config_.observability);
  exposure_ = equations.exposure;
  step.undetermined = split.open;
  step.photometric_reliability = split.least_determined;
  step.photometric_information = equations.information.A;
  step.compared_share = static_cast<double>(equations.pixels) / static_cast<double>(pixels);
  const Vector6d photometric_part = solve_in(split.determined, equations.information.A,
                                             equations.b - equations.information.A * step.xi);
  step.xi += photometric_part;
}

}  // namespace kintsugi::mapper
