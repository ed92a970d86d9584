#include "mapper/core/tracking/loss_rule.hpp"

#include <algorithm>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::mapper {

void Evidence::validate(const std::string& name) const {
  check_range(name + ".min_overlap_share", min_overlap_share, 0.0, 1.0);
  check_range(name + ".min_inlier_share", min_inlier_share, 0.0, 1.0);
  check_range(name + ".max_behind_share", max_behind_share, 0.0, 1.0);
  check_range(name + ".max_in_front_share", max_in_front_share, 0.0, 1.0);
  check_range(name + ".max_rms_vox", max_rms_vox, 1e-3, 1e3);
  check_range(name + ".max_rms_sigmas", max_rms_sigmas, 1e-3, 1e3);
  check_range(name + ".max_sigma_vox", max_sigma_vox, 1e-3, 1e6);
  check_range(name + ".max_sigma_noises", max_sigma_noises, 0.0, 1e6);
}

std::optional<LossReason> find_fault(const RegistrationQuality& quality, const Evidence& needed) {
  if (!quality.solved) return LossReason::kNotSolved;
  if (quality.overlap_share < needed.min_overlap_share) return LossReason::kTooLittleOverlap;
  if (quality.inlier_share < needed.min_inlier_share) return LossReason::kTooFewInliers;
  if (quality.behind_share > needed.max_behind_share) return LossReason::kThroughSurface;
  if (quality.in_front_share > needed.max_in_front_share) return LossReason::kBeforeSurface;
  if (quality.rms_m > needed.max_rms_vox * quality.voxel_m &&
      quality.rms_sigmas > needed.max_rms_sigmas) {
    return LossReason::kLargeResidual;
  }
  if (quality.undetermined > 0) return LossReason::kUndetermined;
  if (quality.sigma_m >
      std::max(needed.max_sigma_vox * quality.voxel_m, needed.max_sigma_noises * quality.noise_m)) {
    return LossReason::kUncertain;
  }
  return std::nullopt;
}

void LossRule::Config::validate() const {
  check_range("min_covered_share", min_covered_share, 0.0, 1.0);
  check_range("max_covered_drop", max_covered_drop, 0.0, 1.0);
  check_range("recent_view_decay", recent_view_decay, 0.0, 1.0);
  following.validate("following");
  found_anew.validate("found_anew");
  check_range("usual_decay", usual_decay, 0.0, 1.0);
  check_range("max_usual_share", max_usual_share, 0.0, 1.0);
  check_range("unusual_factor", unusual_factor, 1.0, 1e3);
  check_range("much_worse_factor", much_worse_factor, 1.0, 1e3);
  check_range("grace_frames", grace_frames, 0, 1'000'000);
}

std::string_view to_string(LossReason reason) {
  switch (reason) {
    case LossReason::kTooFewPixels:
      return "too few pixels have a depth inside the volume";
    case LossReason::kViewCutOff:
      return "the share of pixels with a valid depth dropped suddenly";
    case LossReason::kNotSolved:
      return "registration has no solution";
    case LossReason::kTooLittleOverlap:
      return "too small an overlap between the view and the map";
    case LossReason::kTooFewInliers:
      return "too few inliers between the view and the map";
    case LossReason::kThroughSurface:
      return "too many measured points are behind surfaces of the map";
    case LossReason::kBeforeSurface:
      return "too many measured points are in front of surfaces of the map";
    case LossReason::kLargeResidual:
      return "residuals are too large";
    case LossReason::kUncertain:
      return "the pose is too uncertain";
    case LossReason::kUndetermined:
      return "camera motion along the surface is unobservable";
    case LossReason::kMuchWorseThanUsual:
      return "far more outliers and larger residuals than usual";
  }
  return "unknown";
}

LossRule::LossRule(const Config& config) : config_(config) { config_.validate(); }

std::optional<LossReason> LossRule::judge(const RegistrationQuality& quality) const {
  if (quality.covered_share < config_.min_covered_share) return LossReason::kTooFewPixels;
  if (is_cut_off(quality)) return LossReason::kViewCutOff;
  Evidence needed = allow_usual(config_.following);
  if (accepted_frames_ < config_.grace_frames) needed.min_inlier_share = 0.0;
  return find_fault(quality, needed);
}

std::optional<LossReason> LossRule::judge_found_anew(const RegistrationQuality& quality) const {
  if (quality.covered_share < config_.min_covered_share) return LossReason::kTooFewPixels;
  const auto fault = find_fault(quality, allow_usual(config_.found_anew));
  if (!fault && fits_much_worse_than_usual(quality)) return LossReason::kMuchWorseThanUsual;
  return fault;
}

bool LossRule::fits_worse_than_usual(const RegistrationQuality& quality) const {
  if (!usual_fit_) return false;
  return quality.outlier_share() > config_.unusual_factor * usual_fit_->outlier_share ||
         quality.rms_sigmas > config_.unusual_factor * usual_fit_->rms_sigmas;
}

/// Both, because where the camera finds itself again much may be new or have been seen from another
/// side only, which are outliers, or it may be near, where voxels leave residuals.
bool LossRule::fits_much_worse_than_usual(const RegistrationQuality& quality) const {
  if (!usual_fit_) return false;
  return quality.outlier_share() > config_.much_worse_factor * usual_fit_->outlier_share &&
         quality.rms_sigmas > config_.much_worse_factor * usual_fit_->rms_sigmas;
}

void LossRule::remember(const RegistrationQuality& quality, bool accepted) {
  recent_covered_share_ =
      std::max(quality.covered_share, config_.recent_view_decay * recent_covered_share_);
  if (!accepted) return;
  ++accepted_frames_;
  if (quality.overlap_share <= 0.0) return;
  const auto mix = [this](double& usual, double share) {
    usual = config_.usual_decay * usual + (1.0 - config_.usual_decay) * share;
  };
  mix(usual_behind_share_, quality.behind_share);
  mix(usual_in_front_share_, quality.in_front_share);
  if (!usual_fit_) usual_fit_ = {quality.outlier_share(), quality.rms_sigmas};
  mix(usual_fit_->outlier_share, quality.outlier_share());
  mix(usual_fit_->rms_sigmas, quality.rms_sigmas);
}

Evidence LossRule::allow_usual(Evidence needed) const {
  needed.max_behind_share += std::min(usual_behind_share_, config_.max_usual_share);
  needed.max_in_front_share += std::min(usual_in_front_share_, config_.max_usual_share);
  return needed;
}

bool LossRule::is_cut_off(const RegistrationQuality& quality) const {
  return quality.covered_share < (1.0 - config_.max_covered_drop) * recent_covered_share_;
}

}  // namespace kintsugi::mapper
