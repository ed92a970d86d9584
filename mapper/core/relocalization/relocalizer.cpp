#include "mapper/core/relocalization/relocalizer.hpp"

#include <algorithm>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/trajectory.hpp"
#include "mapper/core/relocalization/feature_pose.hpp"
#include "mapper/core/relocalization/intensity_agreement.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kTries = 2;  // for a frame

/// The level to which KeyframeAppearance::intensity belongs.
const SurfaceMap& coarse(const SurfacePyramid& pyramid) {
  return pyramid[std::min<std::size_t>(1, pyramid.size() - 1)];
}

/// `X_UK` and `X_UC`: of the keyframe and of the frame.
std::optional<double> correlation_between(const Keyframe& keyframe, const Pose& X_UK,
                                          const SurfaceMap& surface_K,
                                          const KeyframeAppearance& appearance,
                                          const TrackingInput& frame, const Pose& X_UC) {
  if (appearance.intensity.empty() || keyframe.appearance.intensity.empty()) return std::nullopt;
  return intensity_agreement(coarse(frame.surface_C), appearance.intensity, surface_K,
                             keyframe.appearance.intensity, X_UK.inverse(Eigen::Isometry) * X_UC);
}

TrackingResult found(TrackingResult result, std::optional<int> at_keyframe) {
  result.state = TrackingState::kTracking;
  result.loss_reason.reset();
  result.found_by_keyframe = at_keyframe;
  return result;
}

}  // namespace

void Relocalizer::Config::validate() const {
  keyframes.validate();
  check_range("min_overlap_share", min_overlap_share, 0.0, 1.0);
  check_range("min_correlation", min_correlation, -1.0, 1.0);
  check_range("feature_distance_m", feature_distance_m, 0.0, 100.0);
  check_range("feature_angle_rad", feature_angle_rad, 0.0, 3.2);
  with_features.validate("with_features");
}

Relocalizer::Relocalizer(const Config& config)
    : config_((config.validate(), config)), keyframes_(config.keyframes) {}

bool Relocalizer::remember(const TrackingInput& frame, const Model& model) {
  turn_ = 0;
  voxel_m_ = model.voxel_m;
  if (keyframes_.find_near(model.X_WV)) return false;
  keyframes_.add(model.X_WV, frame, coarse(model.surface_V));
  return true;
}

std::optional<TrackingResult> Relocalizer::find(const TrackingInput& frame, const Tracker& tracker,
                                                const ModelFrom& model_from,
                                                const PlaceOf& place_of) {
  const KeyframeAppearance appearance = appearance_of(frame, config_.keyframes.max_features);
  const auto place = [&](int number) {
    return place_of ? place_of(number) : Place{.way_m = tracker.path_m()};
  };
  const auto is_in_reach = [&](const Place& place, const Pose& X_NC) {
    return tracker.can_be_at(place.motion * X_NC, frame.utime, place.way_m, tracker.reach_m());
  };
  const std::vector<int> candidates = keyframes_.similar_to(
      appearance, [&](int number) { return is_in_reach(place(number), keyframes_[number].X_WC); });
  int num_tried = 0;
  for (std::size_t i = 0; i < candidates.size() && num_tried < kTries; ++i) {
    const int number = candidates[i == 0 ? 0 : 1 + turn_++ % (candidates.size() - 1)];
    const Keyframe& keyframe = keyframes_[number];
    Candidate candidate{number, place(number), {}};
    if (const auto X_KC = pose_from_features(keyframe.appearance.features, appearance.features)) {
      candidate.X_NC_features = keyframe.X_WC * *X_KC;
    }
    if (!is_in_reach(candidate.place, candidate.X_NC_features.value_or(keyframe.X_WC))) continue;
    ++num_tried;
    if (auto found = try_candidate(candidate, appearance, frame, tracker, model_from)) return found;
  }
  return std::nullopt;
}

std::optional<TrackingResult> Relocalizer::try_candidate(const Candidate& candidate,
                                                         const KeyframeAppearance& appearance,
                                                         const TrackingInput& frame,
                                                         const Tracker& tracker,
                                                         const ModelFrom& model_from) const {
  const auto& [number, place, X_NC_features] = candidate;
  const Keyframe& keyframe = keyframes_[number];
  const Pose& X_NK = keyframe.X_WC;  // N: as the keyframe was tracked
  const int levels = static_cast<int>(frame.surface_C.size());
  const Model seen_then{pyramid_from_surface(keyframe.surface(), levels), X_NK, voxel_m_};
  const SurfaceMap& surface_K = seen_then.surface_V.front();
  TrackingResult near = tracker.register_anew(frame, seen_then, X_NC_features.value_or(X_NK));
  if (near.quality.overlap_share < config_.min_overlap_share) return std::nullopt;
  if (!tracker.can_be_at(place.motion * near.X_WC, frame.utime, place.way_m)) return std::nullopt;

  // U: as the volume was. Of a released keyframe tracking has drifted since then.
  const bool is_in_volume = !keyframes_.is_released()[number];
  const Pose X_UN = is_in_volume ? Pose::Identity() : place.motion;
  TrackingResult in_map =
      tracker.register_anew(frame, model_from(X_UN * near.X_WC), X_UN * near.X_WC);
  if (in_map.quality.overlap_share >= config_.min_overlap_share) {
    std::optional<Pose> X_UC_features;
    if (X_NC_features) X_UC_features = X_UN * *X_NC_features;
    const auto correlation =
        correlation_between(keyframe, X_UN * X_NK, surface_K, appearance, frame, in_map.X_WC);
    if (!is_accepted(in_map, X_UC_features, correlation)) return std::nullopt;
    return found(std::move(in_map), is_in_volume ? std::optional(number) : std::nullopt);
  }
  const auto correlation =
      correlation_between(keyframe, X_NK, surface_K, appearance, frame, near.X_WC);
  // The lower requirements are for drift against the map; a keyframe's own surface has none.
  if (!is_accepted(near, std::nullopt, correlation)) return std::nullopt;
  return found(std::move(near), number);
}

bool Relocalizer::is_accepted(const TrackingResult& result,
                              const std::optional<Pose>& X_WC_features,
                              std::optional<double> correlation) const {
  // A small overlap may fit in many places.
  if (result.quality.overlap_share < config_.with_features.min_overlap_share) return false;
  if (correlation && *correlation < config_.min_correlation) return false;
  if (result.state == TrackingState::kTracking) return true;
  if (!X_WC_features) return false;
  const Pose X_FC =
      X_WC_features->inverse() * result.X_WC;  // F: the camera according to the features
  return X_FC.translation().norm() < config_.feature_distance_m &&
         rotation_angle_rad(X_FC) < config_.feature_angle_rad &&
         !find_fault(result.quality, config_.with_features);
}

}  // namespace kintsugi::mapper
