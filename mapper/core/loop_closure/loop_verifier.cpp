#include "mapper/core/loop_closure/loop_verifier.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/trajectory.hpp"
#include "mapper/core/registration/motion_size.hpp"
#include "mapper/core/relocalization/feature_pose.hpp"
#include "mapper/core/relocalization/intensity_agreement.hpp"

namespace kintsugi::mapper {
namespace {

SurfacePyramid pyramid_of(const Keyframe& keyframe, const DepthNoise& noise, int levels) {
  SurfaceMap surface = keyframe.surface();
  surface.noise = noise;
  return pyramid_from_surface(std::move(surface), levels);
}

bool is_near(const Pose& X_AB, const Pose& X_AC, const LoopVerifier::Config& config) {
  const Pose X_BC = X_AB.inverse() * X_AC;
  return X_BC.translation().norm() < config.feature_distance_m &&
         rotation_angle_rad(X_BC) < config.feature_angle_rad;
}

double difference(const Pose& X_AB, const Pose& X_AC) { return motion_size(X_AB.inverse() * X_AC); }

}  // namespace

void LoopVerifier::Config::validate() const {
  registration.validate();
  evidence.validate("evidence");
  expected.validate("expected");
  check_range("max_disagreement_sigmas", max_disagreement_sigmas, 0.0, 1e3);
  check_range("min_correlation", min_correlation, -1.0, 1.0);
  check_range("feature_distance_m", feature_distance_m, 0.0, 100.0);
  check_range("feature_angle_rad", feature_angle_rad, 0.0, 3.2);
  check_range("voxel_m", voxel_m, 1e-4, 1.0);
}

LoopVerifier::LoopVerifier(const Config& config) : config_((config.validate(), config)) {}

std::optional<KeyframeMatch> LoopVerifier::match(const Keyframe& later, const Keyframe& earlier,
                                                 const Pose& X_EL_start,
                                                 const DepthNoise& noise) const {
  const int levels = static_cast<int>(config_.registration.iterations.size());
  const SurfacePyramid surface_L = pyramid_of(later, noise, levels);
  const SurfacePyramid surface_E = pyramid_of(earlier, noise, levels);
  const auto X_EL_features =
      pose_from_features(earlier.appearance.features, later.appearance.features);
  const auto forward =
      registered(surface_L, surface_E, X_EL_features.value_or(X_EL_start), config_.evidence);
  if (!forward) return std::nullopt;
  const Pose& X_EL = forward->X_WC;
  if (X_EL_features && !is_near(*X_EL_features, X_EL, config_)) return std::nullopt;
  const auto backward = registered(surface_E, surface_L, X_EL.inverse(), config_.evidence);
  if (!backward) return std::nullopt;
  const double sigma_m = std::hypot(forward->quality.sigma_m, backward->quality.sigma_m);
  const double limit_m = config_.max_disagreement_sigmas * sigma_m + config_.voxel_m;
  if (difference(backward->X_WC.inverse(), X_EL) > limit_m) return std::nullopt;
  const KeyframeAppearance& looks_L = later.appearance;
  const KeyframeAppearance& looks_E = earlier.appearance;
  if (!looks_L.intensity.empty() && !looks_E.intensity.empty()) {
    const auto correlation = intensity_agreement(surface_L.front(), looks_L.intensity,
                                                 surface_E.front(), looks_E.intensity, X_EL);
    if (correlation && *correlation < config_.min_correlation) return std::nullopt;
  }
  return KeyframeMatch{X_EL, forward->information_C, forward->quality.sigma_m};
}

std::optional<KeyframeMatch> LoopVerifier::match_expected(const Keyframe& later,
                                                          const Keyframe& earlier,
                                                          const Pose& X_EL_expected,
                                                          const DepthNoise& noise) const {
  const int levels = static_cast<int>(config_.registration.iterations.size());
  const auto found =
      registered(pyramid_of(later, noise, levels), pyramid_of(earlier, noise, levels),
                 X_EL_expected, config_.expected);
  if (!found) return std::nullopt;
  return KeyframeMatch{found->X_WC, found->information_C, found->quality.sigma_m};
}

std::optional<Registration> LoopVerifier::registered(const SurfacePyramid& frame,
                                                     const SurfacePyramid& model,
                                                     const Pose& X_MF_start,
                                                     const Evidence& needed) const {
  const TrackingInput input{.utime = 0, .surface_C = frame, .color_rgb = {}};
  const Model seen{.surface_V = model, .X_WV = Pose::Identity(), .voxel_m = config_.voxel_m};
  Registration found = register_frame_widely(input, seen, {}, X_MF_start, config_.registration);
  if (find_fault(found.quality, needed)) return std::nullopt;
  return found;
}

}  // namespace kintsugi::mapper
