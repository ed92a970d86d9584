#pragma once
// Finds the camera in the map after tracking was lost.

#include <functional>
#include <optional>

#include "mapper/core/frame/tracking_input.hpp"
#include "mapper/core/registration/model.hpp"
#include "mapper/core/relocalization/keyframe_map.hpp"
#include "mapper/core/tracking/tracker.hpp"

namespace kintsugi::mapper {

/// Keeps keyframes while the camera is tracked, and compares a lost frame with them.
///
/// A candidate is a keyframe that shares features with the frame or has a similar depth thumbnail.
/// The frame is registered first with the keyframe's surface, from the pose that the features give
/// or else from the keyframe's pose; then with the map as seen from the pose found. This second
/// registration must pass the loss rule for poses found anew. Where the volume no longer covers the
/// place, the first registration must pass it instead. With surface in the volume that is not the
/// keyframe's, because that was released, the frame is registered where the corrected map has the
/// keyframe, and the pose found is in the frame of the volume. If both frames have colour, their
/// intensities must not contradict the pose. A pose from features that agrees with the registration
/// is an independent second estimate; the requirements are then lower (with_features), because
/// after a long loop the accumulated drift puts the frame a few centimetres off the map.
///
/// A candidate is tried only where the camera can have got: otherwise rooms that look alike take
/// the turns of the right one until the camera has been lost for long enough to be in them.
///
/// The work for one frame is bounded: two candidates are tried, the best one and the others in
/// turn, so that all candidates are tried within as many frames.
class Relocalizer {
 public:
  struct Config {
    KeyframeMap::Config keyframes;
    double min_overlap_share = 0.2;  ///< below it the volume does not cover the place any more
    double min_correlation = 0.5;  ///< of intensities, see intensity_agreement(); right poses have
                                   ///< 0.63 and more, but wrong poses may reach that too
    /// Largest distance between the features' pose and the registered one for them to agree.
    double feature_distance_m = 0.1;
    double feature_angle_rad = 0.1;
    Evidence with_features{.min_overlap_share = 0.25,
                           .min_inlier_share = 0.4,
                           .max_behind_share = 0.16,
                           .max_in_front_share = 0.2,
                           .max_rms_vox = 1.6,
                           .max_rms_sigmas = 2.2,
                           .max_sigma_vox = 1.15,
                           .max_sigma_noises = 0.5};

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// Raycasts the map's surface as seen from a pose.
  using ModelFrom = std::function<Model(const Pose& X_WV)>;

  /// @throws std::invalid_argument if the configuration is not valid
  explicit Relocalizer(const Config& config);

  /// To be called after each fused frame. `model` is the map's surface as seen from its pose.
  /// @returns whether the frame became a keyframe
  bool remember(const TrackingInput& frame, const Model& model);

  /// Where the map, as corrected, has what a keyframe saw.
  struct Place {
    Pose motion = Pose::Identity();  ///< to the frame in which the camera was tracked last
    double way_m = 0.0;              ///< on which tracking may have drifted between both
  };
  using PlaceOf = std::function<Place(int keyframe)>;

  /// The camera's pose, if the frame can be registered with one of the keyframes that are tried
  /// now and the camera can have got there. `tracker` does not change. Without `place_of` nothing
  /// was corrected, and tracking may have drifted on all of the camera's path.
  std::optional<TrackingResult> find(const TrackingInput& frame, const Tracker& tracker,
                                     const ModelFrom& model_from, const PlaceOf& place_of = {});

  KeyframeMap& keyframes() { return keyframes_; }
  int num_keyframes() const { return keyframes_.size(); }

 private:
  struct Candidate {
    int number = 0;  ///< of the keyframe
    Place place;
    std::optional<Pose> X_NC_features;  ///< from features, in the frame N of the keyframe
  };
  std::optional<TrackingResult> try_candidate(const Candidate& candidate,
                                              const KeyframeAppearance& appearance,
                                              const TrackingInput& frame, const Tracker& tracker,
                                              const ModelFrom& model_from) const;
  /// `X_WC_features`: the pose from features, if there is one.
  bool is_accepted(const TrackingResult& result, const std::optional<Pose>& X_WC_features,
                   std::optional<double> correlation) const;

  Config config_;
  KeyframeMap keyframes_;
  double voxel_m_ = Model().voxel_m;  ///< of the map, as in the last model that was remembered
  std::size_t turn_ = 0;              ///< chooses among the candidates after the first one
};

}  // namespace kintsugi::mapper
