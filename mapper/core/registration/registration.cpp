#include "mapper/core/registration/registration.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/frame/covered_share.hpp"
#include "mapper/core/registration/observability.hpp"
#include "mapper/core/registration/pose_uncertainty.hpp"

namespace kintsugi::mapper {
namespace {

/// From the worse of two starts there are this many times as many outliers, or both are alike:
/// along a direction that nothing determines the same pixels fit, wherever one starts.
constexpr double kMuchBetter = 2.0;

/// The product of many rotations drifts off SO(3); this projects back to it.
Pose orthonormal(const Pose& X) {
  Pose clean = X;
  clean.linear() = Eigen::Quaterniond(X.linear()).normalized().toRotationMatrix();
  return clean;
}

/// The shares and residuals that the normal equations counted.
RegistrationQuality quality_of(const NormalEquations& equations, std::size_t num_pixels) {
  RegistrationQuality quality;
  const auto overlap = static_cast<double>(equations.agreement.overlap);
  quality.overlap_share = overlap / static_cast<double>(num_pixels);
  if (overlap > 0.0) {
    quality.inlier_share = static_cast<double>(equations.inliers) / overlap;
    quality.behind_share = static_cast<double>(equations.agreement.behind) / overlap;
    quality.in_front_share = static_cast<double>(equations.agreement.in_front) / overlap;
  }
  if (equations.inliers > 0) {
    const auto inliers = static_cast<double>(equations.inliers);
    quality.rms_m = std::sqrt(equations.squared_residuals_m2 / inliers);
    quality.rms_sigmas = std::sqrt(equations.weighted_squares / inliers);
    if (quality.rms_sigmas > 0.0) quality.noise_m = quality.rms_m / quality.rms_sigmas;
  }
  return quality;
}

class CoarseToFine {
 public:
  CoarseToFine(const TrackingInput& frame, const Model& model, const PhotometricPair& colors,
               const Pose& X_WC_start, const RegistrationConfig& config, bool wide)
      : frame_C_(frame.surface_C),
        model_(model),
        config_(config),
        coarsest_(static_cast<int>(config.iterations.size()) - 1),
        wide_(wide),
        solver_(frame.surface_C, model, colors, config.steps),
        X_VC_(model.X_WV.inverse() * X_WC_start) {}

  /// The coarsest level. Returns *this.
  CoarseToFine& begin() {
    level_ = coarsest_;
    solved_ = register_level();
    return *this;
  }

  /// After begin(): the levels below.
  Registration finish() {
    while (solved_ && level_ > 0) {
      --level_;
      solved_ = register_level();
    }
    return result();
  }

  /// Whether the levels so far had a solution.
  bool is_solved() const { return solved_; }

  /// After begin() of both, from two starts.
  bool is_supported_more_than(const CoarseToFine& other) const {
    if (!solved_ || !other.solved_) return solved_ && !other.solved_;
    return quality().support() > other.quality().support();
  }

  /// So far.
  Pose X_WC() const { return model_.X_WV * X_VC_; }

  /// After begin(): a left increment of X_VC, 1 m or 1 rad, of which the surfaces tell least.
  Vector6d least_known_motion() const {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(equations_.A);
    const Vector6d xi = eigen.eigenvectors().col(0);  // of the least eigenvalue
    return xi / std::max(xi.head<3>().norm(), xi.tail<3>().norm());
  }

  /// After begin() of both, from two starts.
  bool fits_much_better_than(const CoarseToFine& other) const {
    if (!solved_ || !other.solved_) return solved_;
    return equations_.inliers > other.equations_.inliers &&
           kMuchBetter * quality().outlier_share() < other.quality().outlier_share();
  }

 private:
  RegistrationQuality quality() const {
    return quality_of(equations_, frame_C_[level_].depth_m.total());
  }

  /// False if a step had no solution.
  bool register_level() {
    const bool widened = wide_ && level_ == coarsest_;
    IcpGates gates = config_.gates;
    if (widened) gates.max_distance_m *= config_.wide_gate_factor;
    const int steps = config_.iterations[level_] * (widened ? config_.wide_iteration_factor : 1);
    std::optional<InfluenceLimits> limits;
    if (level_ == 0 && coarsest_ > 0) limits = config_.influence;
    const double small_enough = config_.early_exit * std::exp2(level_);
    // First with the rough start pose, then again when the pose is nearly final.
    if (level_ == coarsest_ || level_ == 0) observe(gates);
    for (int i = 0; i < steps; ++i) {
      equations_ = linearize(frame_C_[level_], model_.surface_V[level_], X_VC_, gates, limits);
      const auto step = solver_.solve(equations_, level_, X_VC_);
      if (!step) return false;
      step_ = *step;
      X_VC_ = se3_retract(step_.xi) * X_VC_;
      ++iterations_;
      if (step_.xi.norm() < small_enough) break;
    }
    return true;
  }

  /// Decides which directions depth determines; for the finest level on the second finest images,
  /// which have a quarter of the pixels.
  void observe(const IcpGates& gates) {
    const int level = std::min(std::max(level_, 1), coarsest_);
    const SurfaceMap& surface_C = frame_C_[level];
    solver_.observe(
        independent(geometric_information(surface_C, model_.surface_V[level], X_VC_, gates),
                    surface_C.depth_m.total()));
    step_ = Step();
    step_.undetermined = solver_.open_to_depth();
  }

  Registration result() const {
    const std::size_t num_pixels = frame_C_[level_].depth_m.total();
    Registration registration;
    registration.X_WC = orthonormal(model_.X_WV * X_VC_);
    registration.iterations = iterations_;
    RegistrationQuality& quality = registration.quality;
    quality = this->quality();
    quality.solved = solved_;
    quality.voxel_m = model_.voxel_m;
    quality.covered_share = covered_share(frame_C_.front(), registration.X_WC, model_.region_W);
    const Matrix6d A = equations_.A + step_.further_information;
    quality.sigma_m = pose_sigma_m(A, X_VC_, static_cast<int>(num_pixels));
    registration.information_C = information_of_pose(A, X_VC_, static_cast<int>(num_pixels));
    quality.undetermined = static_cast<int>(step_.undetermined.cols());
    const Matrix6d to_C = adjoint(X_VC_.inverse());
    registration.open_to_depth_C = to_C * solver_.open_to_depth();
    registration.undetermined_C = to_C * step_.undetermined;
    registration.compared_share = step_.compared_share;
    registration.photometric_reliability = step_.photometric_reliability;
    return registration;
  }

  const SurfacePyramid& frame_C_;
  const Model& model_;
  const RegistrationConfig& config_;
  const int coarsest_;
  const bool wide_;
  StepSolver solver_;
  int level_ = 0;
  Pose X_VC_;
  NormalEquations equations_;  ///< before the last step
  Step step_;                  ///< the last one
  bool solved_ = false;
  int iterations_ = 0;
};

/// `X_WC`, and poses on both sides of it, moved by a twist in V: as far as the wide gate reaches,
/// the nearest first.
std::vector<Pose> along(const Vector6d& twist_V, const Pose& X_WC, const Model& model,
                        const RegistrationConfig& config) {
  const Pose X_VC = model.X_WV.inverse() * X_WC;
  std::vector<Pose> poses = {X_WC};
  for (int i = 1; i <= config.wide_gate_factor; ++i) {
    for (const double step : {i * config.gates.max_distance_m, -i * config.gates.max_distance_m}) {
      poses.push_back(model.X_WV * se3_retract(step * twist_V) * X_VC);
    }
  }
  return poses;
}

}  // namespace

void RegistrationConfig::validate() const {
  check_range<std::size_t>("number of ICP levels", iterations.size(), 1, 8);
  for (const int count : iterations) check_range("ICP iterations", count, 1, 1000);
  check_range("max_distance_m", gates.max_distance_m, 1e-3, 10.0);
  check_range("min_normal_cosine", gates.min_normal_cosine, -1.0, 1.0);
  check_range("influence.full_sigmas", influence.full_sigmas, 1e-3, 1e6);
  check_range("influence.none_sigmas", influence.none_sigmas, 1.001 * influence.full_sigmas, 1e9);
  check_range("early_exit", early_exit, 0.0, 1.0);
  check_range("wide_gate_factor", wide_gate_factor, 1.0, 100.0);
  check_range("wide_iteration_factor", wide_iteration_factor, 1, 100);
  check_range("close_gate_factor", close_gate_factor, 1.0, 100.0);
  steps.observability.validate();
  steps.edges.validate();
  steps.photometric.validate();
}

Registration register_frame(const TrackingInput& frame, const Model& model,
                            const PhotometricPair& colors, const Pose& X_WC_start,
                            const RegistrationConfig& config) {
  return CoarseToFine(frame, model, colors, X_WC_start, config, false).begin().finish();
}

Registration register_frame(const TrackingInput& frame, const Model& model,
                            const PhotometricPair& colors, const Pose& X_WC_start,
                            const Pose& X_WC_other_start, const RegistrationConfig& config) {
  CoarseToFine from_start(frame, model, colors, X_WC_start, config, false);
  CoarseToFine from_other(frame, model, colors, X_WC_other_start, config, false);
  const bool other = from_other.begin().fits_much_better_than(from_start.begin());
  return (other ? from_other : from_start).finish();
}

Registration register_frame_closely(const TrackingInput& frame, const Model& model,
                                    const PhotometricPair& colors, const Pose& X_WC_start,
                                    const RegistrationConfig& config) {
  RegistrationConfig close = config;
  close.gates.max_distance_m /= config.close_gate_factor;
  return register_frame(frame, model, colors, X_WC_start, close);
}

Registration register_frame_widely(const TrackingInput& frame, const Model& model,
                                   const PhotometricPair& colors, const Pose& X_WC_start,
                                   const RegistrationConfig& config) {
  CoarseToFine wide(frame, model, colors, X_WC_start, config, true);
  if (!wide.begin().is_solved()) return wide.finish();
  std::optional<CoarseToFine> best;
  for (const Pose& X_WC : along(wide.least_known_motion(), wide.X_WC(), model, config)) {
    CoarseToFine from_there(frame, model, colors, X_WC, config, false);
    from_there.begin();
    if (!best || from_there.is_supported_more_than(*best)) best.emplace(from_there);
  }
  return best->finish();
}

}  // namespace kintsugi::mapper
