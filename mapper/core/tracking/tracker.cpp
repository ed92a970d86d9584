#include "mapper/core/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/registration/motion_size.hpp"
#include "mapper/core/registration/twist.hpp"

namespace kintsugi::mapper {
namespace {

/// The errors of a pose and of the prediction from the two before it are smaller than this, in
/// units of the pose's uncertainty...
constexpr double kPoseNoise_sigmas = 4.0;
/// ...or than this, metres (and radians): shaking hands.
constexpr double kPoseNoise_m = 0.02;
/// Metres or radians between photometric references while colour is needed.
constexpr double kMinReferenceStep = 0.05;

/// The constant velocity, a twist per second, that moves `X_WA` to `X_WB` in `seconds`.
Vector6d velocity_between(const Pose& X_WA, const Pose& X_WB, double seconds) {
  const Pose X_AB = X_WA.inverse() * X_WB;
  const Eigen::AngleAxisd rotation(X_AB.linear());
  Vector6d twist;
  twist << X_AB.translation(), rotation.angle() * rotation.axis();
  return twist / seconds;
}

/// All but the state and the reason of a loss.
TrackingResult result_of(const Registration& registration) {
  TrackingResult result;
  result.X_WC = registration.X_WC;
  result.quality = registration.quality;
  result.iterations = registration.iterations;
  result.information_C = registration.information_C;
  result.open_to_depth_C = registration.open_to_depth_C;
  result.undetermined_C = registration.undetermined_C;
  return result;
}

}  // namespace

void Tracker::Config::validate() const {
  registration.validate();
  check_range<std::int64_t>("max_prediction_us", max_prediction_us, 0, 60'000'000);
  check_range<std::int64_t>("coast_us", coast_us, 0, 60'000'000);
  check_range<std::int64_t>("coast_partly_us", coast_partly_us, 0, 60'000'000);
  check_range("max_acceleration", max_acceleration, 0.0, 1e6);
  check_range("max_speed", max_speed, 0.0, 1e6);
  check_range("max_drift_share", max_drift_share, 0.0, 1.0);
  check_range("min_reference_overlap", min_reference_overlap, 0.0, 1.0);
  check_range("min_reference_reliability", min_reference_reliability, 0.0, 1.0);
  loss.validate();
}

Tracker::Tracker(const Config& config) : config_(config), loss_rule_(config.loss) {
  config_.validate();
}

void Tracker::start_at(const Pose& X_WC, const TrackingInput& frame, double covered_share) {
  X_WC_ = X_WC;
  has_pose_ = true;
  utime_ = frame.utime;
  X_WC_followed_ = X_WC_;
  utime_followed_ = utime_;
  velocity_C_.setZero();
  motion_known_ = false;
  lost_ = false;
  loss_rule_.remember({.covered_share = covered_share}, true);
  Registration known;
  known.X_WC = X_WC;
  update_reference(known, {frame.surface_C, frame.color_rgb});
}

bool Tracker::motion_continues(std::int64_t utime) const {
  if (!lost_) return utime - utime_ <= config_.max_prediction_us;
  return utime - utime_followed_ <= config_.coast_us && utime - utime_ <= config_.coast_partly_us;
}

Pose Tracker::predict(std::int64_t utime) const {
  const std::int64_t gap_us = utime - utime_followed_;
  if (!motion_continues(utime)) return X_WC_;
  if (gap_us <= 0) return X_WC_followed_;
  return X_WC_followed_ * se3_retract(velocity_C_ * (1e-6 * static_cast<double>(gap_us)));
}

TrackingResult Tracker::track(const TrackingInput& frame, const Model& model) {
  PhotometricPyramid pyramid(frame.surface_C, frame.color_rgb);
  const PhotometricPair colors{&pyramid,
                               pyramid.has_color() && reference_ ? &*reference_ : nullptr};
  Judged judged = register_by_motion(frame, model, colors);
  const std::optional<LossReason> first_loss = judged.loss;
  if (first_loss == LossReason::kUndetermined) follow_partly(judged.registration, frame.utime);
  judged = search_further(judged, frame, model, colors);
  const auto& [registration, loss] = judged;
  loss_rule_.remember(registration.quality, !loss);
  if (!loss) update_reference(registration, std::move(pyramid));
  TrackingResult result = loss ? lose(registration, *loss) : accept(registration, frame);
  result.first_loss_reason = first_loss;
  if (loss && utime_followed_ < frame.utime) follow_last_frame(frame);
  last_frame_.reset();
  if (utime_followed_ == frame.utime) {
    last_frame_ = Model{frame.surface_C, X_WC_followed_, model.voxel_m};
  }
  return result;
}

/// From the predicted pose, or from where the camera was: it may have stopped or turned back.
Tracker::Judged Tracker::register_by_motion(const TrackingInput& frame, const Model& model,
                                            const PhotometricPair& colors) const {
  const Pose X_WC = predict(frame.utime);
  const bool moves = motion_size(X_WC_followed_.inverse(Eigen::Isometry) * X_WC) > kPoseNoise_m;
  return judge_by_motion(
      moves ? register_frame(frame, model, colors, X_WC, X_WC_followed_, config_.registration)
            : register_frame(frame, model, colors, X_WC, config_.registration),
      frame.utime);
}

/// From the predicted pose: surfaces near to those in view may have drawn an accepted one away. It
/// saves none that was rejected: within a closer gate less speaks against a pose that slides.
Tracker::Judged Tracker::register_closely(const TrackingInput& frame, const Model& model,
                                          const PhotometricPair& colors) const {
  return judge_by_motion(
      register_frame_closely(frame, model, colors, predict(frame.utime), config_.registration),
      frame.utime);
}

Tracker::Judged Tracker::judge_by_motion(const Registration& registration,
                                         std::int64_t utime) const {
  return {registration, follows_motion(registration, utime)
                            ? loss_rule_.judge(registration.quality)
                            : loss_rule_.judge_found_anew(registration.quality)};
}

Tracker::Judged Tracker::register_widely(const TrackingInput& frame, const Model& model,
                                         const PhotometricPair& colors) const {
  const Registration registration =
      register_frame_widely(frame, model, colors, X_WC_, config_.registration);
  return {registration, loss_rule_.judge_found_anew(registration.quality)};
}

Tracker::Judged Tracker::search_further(const Judged& by_motion, const TrackingInput& frame,
                                        const Model& model, const PhotometricPair& colors) const {
  if (!is_doubtful(by_motion)) return by_motion;
  Judged better = better_of(by_motion, register_widely(frame, model, colors), frame);
  const bool is_predicted = motion_known_ && motion_continues(frame.utime);
  if (better.loss || !is_predicted || !is_doubtful(better)) return better;
  const Judged closely = register_closely(frame, model, colors);
  return !is_doubtful(closely) && replaces(closely, better) ? closely : better;
}

/// A wrong pose may fit well enough to be accepted, too: nothing but the fit speaks for a pose
/// where the motion is unknown.
bool Tracker::is_doubtful(const Judged& by_motion) const {
  return by_motion.loss || !motion_known_ ||
         loss_rule_.fits_worse_than_usual(by_motion.registration.quality);
}

Tracker::Judged Tracker::better_of(const Judged& by_motion, const Judged& wide,
                                   const TrackingInput& frame) const {
  if (!can_be_at(wide.registration.X_WC, frame.utime, 0.0)) return by_motion;
  return by_motion.loss || replaces(wide, by_motion) ? wide : by_motion;
}

bool Tracker::replaces(const Judged& other, const Judged& first) {
  if (other.loss) return false;
  if (first.loss) return true;
  const Registration& a = first.registration;
  const Registration& b = other.registration;
  const bool is_elsewhere = motion_size(a.X_WC.inverse() * b.X_WC) > kPoseNoise_m;
  return is_elsewhere && b.quality.support() > a.quality.support();
}

TrackingResult Tracker::register_anew(const TrackingInput& frame, const Model& model,
                                      const Pose& X_WC_start) const {
  const Registration registration =
      register_frame_widely(frame, model, {}, X_WC_start, config_.registration);
  TrackingResult result = result_of(registration);
  result.loss_reason = loss_rule_.judge_found_anew(registration.quality);
  result.state = result.loss_reason ? TrackingState::kLost : TrackingState::kTracking;
  return result;
}

void Tracker::change_frame(const Pose& X_NW) {
  X_WC_ = X_NW * X_WC_;
  X_WC_followed_ = X_NW * X_WC_followed_;
  if (reference_) reference_->X_WK = X_NW * reference_->X_WK;
  if (last_frame_) last_frame_->X_WV = X_NW * last_frame_->X_WV;
}

bool Tracker::can_be_at(const Pose& X_WC, std::int64_t utime, double way_m, double reach_m) const {
  if (!has_pose_) return true;
  const double distance_m = (X_WC.translation() - X_WC_.translation()).norm();
  const double seconds = 1e-6 * static_cast<double>(utime - utime_);
  return distance_m - reach_m <=
         kPoseNoise_m + config_.max_speed * seconds + config_.max_drift_share * way_m;
}

bool Tracker::follows_motion(const Registration& registration, std::int64_t utime) const {
  if (!motion_continues(utime)) return false;
  if (!motion_known_) return true;
  const double seconds = 1e-6 * static_cast<double>(utime - utime_followed_);
  const Pose X_PC = predict(utime).inverse() * registration.X_WC;  // P: the predicted camera
  const double noise_m = std::max(kPoseNoise_m, kPoseNoise_sigmas * registration.quality.sigma_m);
  return motion_size(X_PC) < noise_m + 0.5 * config_.max_acceleration * seconds * seconds;
}

bool Tracker::needs_new_reference(const Registration& registration) const {
  if (!reference_ || registration.compared_share < config_.min_reference_overlap) return true;
  if (registration.photometric_reliability >= config_.min_reference_reliability) return false;
  // A nearby reference would hardly be more reliable, and each new one adds to the drift.
  const Pose X_KC = reference_->X_WK.inverse() * registration.X_WC;
  return motion_size(X_KC) > kMinReferenceStep;
}

void Tracker::update_reference(const Registration& registration, PhotometricPyramid frame) {
  if (!frame.has_color()) return;
  const bool depth_sufficed = registration.open_to_depth_C.cols() == 0;
  if (depth_sufficed || needs_new_reference(registration)) {
    reference_ = PhotometricReference{std::move(frame), registration.X_WC};
  }
}

TrackingResult Tracker::accept(const Registration& registration, const TrackingInput& frame) {
  const double seconds = 1e-6 * static_cast<double>(frame.utime - utime_);
  const bool continuous = motion_continues(frame.utime) && seconds > 0.0;
  velocity_C_ = continuous ? velocity_between(X_WC_, registration.X_WC, seconds) : Vector6d::Zero();
  motion_known_ = continuous;
  has_pose_ = true;
  path_m_ += (registration.X_WC.translation() - X_WC_.translation()).norm();
  X_WC_ = registration.X_WC;
  utime_ = frame.utime;
  X_WC_followed_ = X_WC_;
  utime_followed_ = utime_;
  lost_ = false;

  TrackingResult result = result_of(registration);
  result.state = TrackingState::kTracking;
  return result;
}

void Tracker::follow_partly(const Registration& registration, std::int64_t utime) {
  if (!follows_motion(registration, utime)) return;
  const double seconds = 1e-6 * static_cast<double>(utime - utime_followed_);
  if (seconds <= 0.0) return;
  velocity_C_ = velocity_between(X_WC_followed_, registration.X_WC, seconds);
  X_WC_followed_ = registration.X_WC;
  utime_followed_ = utime;
}

void Tracker::follow_last_frame(const TrackingInput& frame) {
  if (!last_frame_ || !motion_continues(frame.utime)) return;
  const Registration registration =
      register_frame(frame, *last_frame_, {}, predict(frame.utime), config_.registration);
  const auto loss = loss_rule_.judge(registration.quality);
  if (!loss || *loss == LossReason::kUndetermined) follow_partly(registration, frame.utime);
}

TrackingResult Tracker::lose(const Registration& registration, LossReason reason) {
  lost_ = true;
  TrackingResult result = result_of(registration);
  result.state = TrackingState::kLost;
  result.X_WC = X_WC_;
  result.loss_reason = reason;
  return result;
}

}  // namespace kintsugi::mapper
