#include "mapper/core/registration/step_solver.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

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
  pure_ = pure_information(geometric, geometry_.open, config_.observability);
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
    add_open_part(geometric, level, X_VC, step);
  }
  if (!step.xi.allFinite()) return std::nullopt;
  return step;
}

void StepSolver::add_open_part(const NormalEquations& geometric, int level, const Pose& X_VC,
                               Step& step) {
  FurtherEquations sum;
  add_edges(level, X_VC, sum);
  if (colors_.frame_C != nullptr && colors_.reference != nullptr) {
    add_intensities(level, X_VC, sum, step);
  }
  step.further_information = sum.H;
  sum.information.A += pure_.information;
  sum.information.C += pure_.information;

  const ObservableSplit split =
      split_observable(sum.information, geometry_.open, sufficient(geometric));
  step.undetermined = split.open;
  step.photometric_reliability = split.least_determined;

  const Matrix6d& W = pure_.weighting;
  const Matrix6d H = sum.H + W.transpose() * geometric.A * W;
  const Vector6d g =
      sum.g - sum.H * step.xi + (W * W).transpose() * (geometric.b - geometric.A * step.xi);
  step.xi += solve_in(split.determined, H, g);
}

ObservabilityConfig StepSolver::sufficient(const NormalEquations& geometric) const {
  ObservabilityConfig config = config_.observability;
  if (!(geometric.weighted_squares > 0.0)) return config;
  const double noise_m = std::sqrt(geometric.squared_residuals_m2 / geometric.weighted_squares);
  // A deviation d has rho = P / (P + D) with P and D the variances of the prior and of d.
  const double ratio = std::max(config.sufficient_priors, noise_m / config.prior_m);
  config.min_reliability = std::min(config.min_reliability, 1.0 / (1.0 + ratio * ratio));
  return config;
}

void StepSolver::add_edges(int level, const Pose& X_VC, FurtherEquations& sum) {
  const SurfaceMap& frame_C = frame_C_[level];
  const SurfaceMap& model_V = model_.surface_V[level];
  std::optional<EdgesOfLevel>& edges = edges_[level];
  if (!edges) edges = EdgesOfLevel{find_depth_edges(frame_C), find_depth_edges(model_V)};
  const EdgeEquations equations =
      linearize_edges(edges->frame_C, frame_C, edges->model_V, model_V, X_VC, config_.edges);
  const std::size_t pixels = frame_C.depth_m.total();
  const double weight = weight_of_edges(pixels);
  const Information shared = independent(equations.information, pixels);
  sum.information.A += weight * shared.A;
  sum.information.C += weight * shared.C;
  sum.H += weight * equations.information.A;
  sum.g += weight * equations.b;
}

void StepSolver::add_intensities(int level, const Pose& X_VC, FurtherEquations& sum, Step& step) {
  const PhotometricImage image_C = colors_.frame_C->level(level);
  PhotometricReference& reference = *colors_.reference;
  const PhotometricEquations equations =
      linearize_photometric(image_C, reference.frame_K.level(level), X_VC,
                            reference.X_WK.inverse() * model_.X_WV, exposure_, config_.photometric);
  exposure_ = equations.exposure;
  const std::size_t pixels = image_C.surface.depth_m.total();
  step.compared_share = static_cast<double>(equations.pixels) / static_cast<double>(pixels);
  const Information shared = independent(equations.information, pixels);
  sum.information.A += shared.A;
  sum.information.C += shared.C;
  sum.H += equations.information.A;
  sum.g += equations.b;
}

}  // namespace kintsugi::mapper
