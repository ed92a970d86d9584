#pragma once
// Finds the camera again in a map it has left behind.

#include <functional>
#include <optional>

#include "mapper/core/relocalization/keyframe_map.hpp"
#include "mapper/core/tracking/tracker.hpp"

namespace kintsugi::mapper {

/// Keeps keyframes while the camera's place is known, and compares a lost frame with them.
///
/// A candidate is a keyframe with features or a depth thumbnail like the frame's. The frame is
/// registered with the keyframe's surface, from the pose that the features say or from the
/// keyframe's; then with the map as seen from the pose found, and it is this second registration
/// that must pass the loss rule for poses found anew. Where the volume does not reach any more, the
/// keyframe's surface takes the map's place. Where both have a picture, their intensities must not
/// contradict the pose. Features that say the same pose are a second witness, and allow for more
/// conflicts with the map: a place that is entered again after a long way round lies a few
/// centimetres off itself.
///
/// The work for one frame is bounded: the best candidate, and one of the others in turn, so that
/// every candidate is tried within as many frames as there are.
class Relocalizer {
 public:
  struct Config {
    KeyframeMap::Config keyframes;
    double min_overlap_share = 0.2;  ///< less of the map's surface in view: the volume has moved on
    double min_correlation = 0.5;  ///< of intensities, see intensity_agreement(); right poses have
                                   ///< 0.63 and more, but wrong ones may have as much
    double witness_distance_m = 0.1;  ///< so near the features' pose must be to that found
    double witness_angle_rad = 0.1;
    Evidence with_witness{.min_overlap_share = 0.25,
                          .min_inlier_share = 0.4,
                          .max_behind_share = 0.16,
                          .max_in_front_share = 0.2,
                          .max_rms_m = 0.014,
                          .max_sigma_m = 0.01};

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// The map's surface as seen from a pose.
  using MapView = std::function<Model(const Pose& X_WV)>;

  /// @throws std::invalid_argument if the configuration is not valid
  explicit Relocalizer(const Config& config);

  /// The frame was fused at the pose of `model`, which is the map's surface as seen from there.
  void remember(const TrackingInput& frame, const Model& model);

  /// Where the camera is, if the frame shows a place that was seen before and this is one of those
  /// that are tried now. Nothing of `tracker` changes.
  std::optional<TrackingResult> find(const TrackingInput& frame, const Tracker& tracker,
                                     const MapView& map_from);

  int num_keyframes() const { return keyframes_.size(); }

 private:
  std::optional<TrackingResult> try_keyframe(const Place& keyframe, const PlaceView& view,
                                             const TrackingInput& frame, const Tracker& tracker,
                                             const MapView& map_from) const;
  /// `X_WC_features`: what the features say, if they say anything.
  bool is_believed(const TrackingResult& result, const std::optional<Pose>& X_WC_features,
                   std::optional<double> correlation) const;

  Config config_;
  KeyframeMap keyframes_;
  std::size_t turn_ = 0;  ///< which of the other candidates is next
};

}  // namespace kintsugi::mapper
