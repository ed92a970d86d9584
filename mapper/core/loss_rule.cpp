#include "mapper/core/loss_rule.hpp"

#include <algorithm>

#include "mapper/core/check.hpp"

namespace kintsugi::mapper {

void LossRule::Config::validate() const {
  check_range("min_covered_share", min_covered_share, 0.0, 1.0);
  check_range("max_covered_drop", max_covered_drop, 0.0, 1.0);
  check_range("recent_view_decay", recent_view_decay, 0.0, 1.0);
  check_range("min_inlier_share", min_inlier_share, 0.0, 1.0);
  check_range("max_rms_m", max_rms_m, 1e-6, 1.0);
  check_range("grace_frames", grace_frames, 0, 1'000'000);
}

std::string_view to_string(LossReason reason) {
  switch (reason) {
    case LossReason::kTooFewPixels:
      return "too few pixels with a depth in the volume";
    case LossReason::kViewCutOff:
      return "most of the view vanished";
    case LossReason::kNotSolved:
      return "registration has no solution";
    case LossReason::kTooFewInliers:
      return "too little of the view fits the map";
    case LossReason::kLargeResidual:
      return "residuals too large";
    case LossReason::kUndetermined:
      return "the view does not tell where along it the camera is";
  }
  return "unknown";
}

LossRule::LossRule(const Config& config) : config_(config) { config_.validate(); }

std::optional<LossReason> LossRule::judge(const RegistrationQuality& quality) const {
  if (quality.covered_share < config_.min_covered_share) return LossReason::kTooFewPixels;
  if (quality.covered_share < (1.0 - config_.max_covered_drop) * recent_covered_share_) {
    return LossReason::kViewCutOff;
  }
  if (!quality.solved) return LossReason::kNotSolved;
  if (believed_frames_ >= config_.grace_frames && quality.inlier_share < config_.min_inlier_share) {
    return LossReason::kTooFewInliers;
  }
  if (quality.rms_m > config_.max_rms_m) return LossReason::kLargeResidual;
  if (quality.undetermined > 0) return LossReason::kUndetermined;
  return std::nullopt;
}

void LossRule::remember(double covered_share, bool believed) {
  recent_covered_share_ =
      std::max(covered_share, config_.recent_view_decay * recent_covered_share_);
  if (believed) ++believed_frames_;
}

}  // namespace kintsugi::mapper
