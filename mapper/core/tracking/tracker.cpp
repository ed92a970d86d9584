#include "mapper/core/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/trajectory.hpp"
#include "mapper/core/tracking/covered_share.hpp"
#include "mapper/core/tracking/pose_uncertainty.hpp"

namespace kintsugi::mapper {
namespace {

/// Poses of single frames scatter by less than this, metres (and radians seen 1 m ahead).
constexpr double kUnsteadiness_m = 0.02;
/// Metres or radians: keyframes for colour are not nearer to each other where it decides alone.
constexpr double kKeyframeStep = 0.05;

/// Twist per second that carries `X_WA` to `X_WB` in `seconds`.
Vector6d velocity_between(const Pose& X_WA, const Pose& X_WB, double seconds) {
  const Pose X_AB = X_WA.inverse() * X_WB;
  const Eigen::AngleAxisd rotation(X_AB.linear());
  Vector6d twist;
  twist << X_AB.translation(), rotation.angle() * rotation.axis();
  return twist / seconds;
}

/// The product of many rotations drifts off SO(3); this is the nearest one to rounding.
Pose orthonormal(const Pose& X) {
  Pose clean = X;
  clean.linear() = Eigen::Quaterniond(X.linear()).normalized().toRotationMatrix();
  return clean;
}

/// Adjoint of X_AB: takes the twist of a left increment of X_BC to that of X_AC.
Matrix6d adjoint(const Pose& X_AB) {
  const Eigen::Vector3d p = X_AB.translation();
  Eigen::Matrix3d cross;
  cross << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0;
  Matrix6d Ad = Matrix6d::Zero();
  Ad.topLeftCorner<3, 3>() = Ad.bottomRightCorner<3, 3>() = X_AB.linear();
  Ad.topRightCorner<3, 3>() = cross * X_AB.linear();
  return Ad;
}

RegistrationQuality quality_of(const NormalEquations& equations, const SurfaceMap& frame,
                               double covered, bool solved) {
  RegistrationQuality quality;
  quality.solved = solved;
  quality.covered_share = covered;
  const auto overlap = static_cast<double>(equations.agreement.overlap);
  quality.overlap_share = overlap / static_cast<double>(frame.depth_m.total());
  if (overlap > 0.0) {
    quality.inlier_share = static_cast<double>(equations.inliers) / overlap;
    quality.behind_share = static_cast<double>(equations.agreement.behind) / overlap;
    quality.in_front_share = static_cast<double>(equations.agreement.in_front) / overlap;
  }
  if (equations.inliers > 0) {
    quality.rms_m =
        std::sqrt(equations.squared_residuals_m2 / static_cast<double>(equations.inliers));
  }
  return quality;
}

}  // namespace

void Tracker::Config::validate() const {
  check_range<std::size_t>("number of ICP levels", iterations.size(), 1, 8);
  for (const int count : iterations) check_range("ICP iterations", count, 1, 1000);
  check_range("max_distance_m", gates.max_distance_m, 1e-3, 10.0);
  check_range("min_normal_cosine", gates.min_normal_cosine, -1.0, 1.0);
  check_range("early_exit", early_exit, 0.0, 1.0);
  check_range("retry_gate_factor", retry_gate_factor, 1.0, 100.0);
  check_range("retry_iteration_factor", retry_iteration_factor, 1, 100);
  check_range<std::int64_t>("max_prediction_us", max_prediction_us, 0, 60'000'000);
  check_range("max_acceleration", max_acceleration, 0.0, 1e6);
  steps.observability.validate();
  steps.photometric.validate();
  check_range("min_keyframe_overlap", min_keyframe_overlap, 0.0, 1.0);
  check_range("min_keyframe_reliability", min_keyframe_reliability, 0.0, 1.0);
  loss.validate();
}

Tracker::Tracker(const Config& config) : config_(config), loss_rule_(config.loss) {
  config_.validate();
}

void Tracker::start_at(const Pose& X_WC, const TrackingInput& frame, double covered_share) {
  X_WC_ = X_WC;
  utime_ = frame.utime;
  velocity_C_.setZero();
  motion_known_ = false;
  lost_ = false;
  loss_rule_.remember(covered_share, true);
  Registration known;
  known.X_WC = X_WC;
  choose_keyframe(known, {frame.surface_C, frame.color_rgb});
}

Pose Tracker::predict(std::int64_t utime) const {
  const std::int64_t gap_us = utime - utime_;
  if (lost_ || gap_us <= 0 || gap_us > config_.max_prediction_us) return X_WC_;
  return X_WC_ * se3_retract(velocity_C_ * (1e-6 * static_cast<double>(gap_us)));
}

TrackingResult Tracker::track(const TrackingInput& frame, const Model& model) {
  PhotometricView view(frame.surface_C, frame.color_rgb);
  const Views views{&view, view.has_color() && keyframe_ ? &*keyframe_ : nullptr};
  Registration registration = register_frame(frame, model, views, predict(frame.utime), false);
  auto loss = follows_motion(registration.X_WC, frame.utime)
                  ? loss_rule_.judge(registration.quality)
                  : loss_rule_.judge_found_anew(registration.quality);
  if (loss) {
    registration = register_widely(frame, model, views, X_WC_);
    loss = loss_rule_.judge_found_anew(registration.quality);
  }
  loss_rule_.remember(registration.quality.covered_share, !loss);
  if (loss) return lose(registration, *loss);
  choose_keyframe(registration, std::move(view));
  return accept(registration, frame);
}

TrackingResult Tracker::register_anew(const TrackingInput& frame, const Model& model,
                                      const Pose& X_WC_start) const {
  const Registration registration = register_widely(frame, model, {}, X_WC_start);
  TrackingResult result;
  result.X_WC = registration.X_WC;
  result.quality = registration.quality;
  result.iterations = registration.iterations;
  result.loss_reason = loss_rule_.judge_found_anew(registration.quality);
  result.state = result.loss_reason ? TrackingState::kLost : TrackingState::kTracking;
  return result;
}

bool Tracker::follows_motion(const Pose& X_WC, std::int64_t utime) const {
  const std::int64_t gap_us = utime - utime_;
  if (lost_ || gap_us > config_.max_prediction_us) return false;
  if (!motion_known_) return true;
  const double seconds = 1e-6 * static_cast<double>(gap_us);
  const Pose X_PC = predict(utime).inverse() * X_WC;  // P: where the camera was expected
  const double surprise_m = std::max(X_PC.translation().norm(), rotation_angle_rad(X_PC));
  return surprise_m < kUnsteadiness_m + 0.5 * config_.max_acceleration * seconds * seconds;
}

Tracker::Registration Tracker::register_widely(const TrackingInput& frame, const Model& model,
                                               const Views& views, const Pose& X_WC_start) const {
  // From far off the steps of one pass do not always suffice.
  const Registration near = register_frame(frame, model, views, X_WC_start, true);
  return near.quality.solved ? register_frame(frame, model, views, near.X_WC, false) : near;
}

Tracker::Registration Tracker::register_frame(const TrackingInput& frame, const Model& model,
                                              const Views& views, const Pose& X_WC_start,
                                              bool wide) const {
  Registration registration;
  const SurfacePyramid& frame_C = frame.surface_C;
  StepSolver solver(views.frame_C, views.keyframe, model.X_WV, config_.steps);
  Pose X_VC = model.X_WV.inverse() * X_WC_start;
  bool solved = true;
  const int coarsest = static_cast<int>(config_.iterations.size()) - 1;
  int level = coarsest + 1;
  while (level > 0 && solved) {
    --level;
    const bool widened = wide && level == coarsest;
    IcpGates gates = config_.gates;
    if (widened) gates.max_distance_m *= config_.retry_gate_factor;
    const int steps = config_.iterations[level] * (widened ? config_.retry_iteration_factor : 1);
    const double small_enough = config_.early_exit * std::exp2(level);
    if (level == coarsest || level == 0) {  // roughly, before the first step; well, near the end
      const int observed = std::min(std::max(level, 1), coarsest);
      const SurfaceMap& surface_C = frame_C[observed];
      solver.observe(
          independent(geometric_information(surface_C, model.surface_V[observed], X_VC, gates),
                      surface_C.depth_m.total()));
    }
    for (int step = 0; step < steps; ++step) {
      registration.equations = linearize(frame_C[level], model.surface_V[level], X_VC, gates);
      const auto xi = solver.solve(registration.equations, level, X_VC);
      solved = xi.has_value();
      if (!solved) break;
      X_VC = se3_retract(*xi) * X_VC;
      ++registration.iterations;
      if (xi->norm() < small_enough) break;
    }
  }
  registration.X_WC = orthonormal(model.X_WV * X_VC);
  registration.quality =
      quality_of(registration.equations, frame_C[level],
                 covered_share(frame_C.front(), registration.X_WC, model.region_W), solved);
  registration.quality.sigma_m =
      pose_sigma_m(registration.equations.A + solver.photometric_information(), X_VC,
                   static_cast<int>(frame_C[level].depth_m.total()));
  registration.quality.undetermined = static_cast<int>(solver.undetermined().cols());
  const Matrix6d to_C = adjoint(X_VC.inverse());
  registration.open_to_depth_C = to_C * solver.open_to_depth();
  registration.undetermined_C = to_C * solver.undetermined();
  registration.compared_share = solver.compared_share();
  registration.photometric_reliability = solver.photometric_reliability();
  return registration;
}

bool Tracker::is_worn(const Registration& registration) const {
  if (!keyframe_ || registration.compared_share < config_.min_keyframe_overlap) return true;
  if (registration.photometric_reliability >= config_.min_keyframe_reliability) return false;
  // One from the frame before would hardly be better, and each change adds an error of its own.
  const Pose X_KC = keyframe_->X_WK.inverse() * registration.X_WC;
  return std::max(X_KC.translation().norm(), rotation_angle_rad(X_KC)) > kKeyframeStep;
}

void Tracker::choose_keyframe(const Registration& registration, PhotometricView view) {
  if (!view.has_color()) return;
  const bool depth_sufficed = registration.open_to_depth_C.cols() == 0;
  if (depth_sufficed || is_worn(registration)) {
    keyframe_ = Keyframe{std::move(view), registration.X_WC};
  }
}

TrackingResult Tracker::accept(const Registration& registration, const TrackingInput& frame) {
  const double seconds = 1e-6 * static_cast<double>(frame.utime - utime_);
  const bool continuous = !lost_ && seconds > 0.0;
  velocity_C_ = continuous ? velocity_between(X_WC_, registration.X_WC, seconds) : Vector6d::Zero();
  motion_known_ = continuous;
  X_WC_ = registration.X_WC;
  utime_ = frame.utime;
  lost_ = false;

  TrackingResult result;
  result.state = TrackingState::kTracking;
  result.X_WC = X_WC_;
  result.quality = registration.quality;
  result.iterations = registration.iterations;
  result.open_to_depth_C = registration.open_to_depth_C;
  result.undetermined_C = registration.undetermined_C;
  return result;
}

TrackingResult Tracker::lose(const Registration& registration, LossReason reason) {
  lost_ = true;
  velocity_C_.setZero();
  motion_known_ = false;
  TrackingResult result;
  result.state = TrackingState::kLost;
  result.X_WC = X_WC_;
  result.quality = registration.quality;
  result.iterations = registration.iterations;
  result.loss_reason = reason;
  result.open_to_depth_C = registration.open_to_depth_C;
  result.undetermined_C = registration.undetermined_C;
  return result;
}

}  // namespace kintsugi::mapper
