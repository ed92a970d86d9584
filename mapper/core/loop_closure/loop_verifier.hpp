#pragma once
// Whether two keyframes show the same place.

#include <optional>

#include "mapper/core/registration/registration.hpp"
#include "mapper/core/relocalization/keyframe_map.hpp"
#include "mapper/core/tracking/loss_rule.hpp"

namespace kintsugi::mapper {

/// The pose of a later keyframe L in an earlier one E.
struct KeyframeMatch {
  Pose X_EL = Pose::Identity();
  Matrix6d information_L = Matrix6d::Zero();  ///< see Registration
  double sigma_m = 0.0;                       ///< see pose_sigma_m()
};

/// Registers the surfaces of two keyframes with each other. Different places may look alike, so it
/// asks for more than one frame in the map does: both directions must pass the loss rule for poses
/// found anew and agree within their uncertainties; where both have features that give a pose, that
/// one must agree too; and where both have colour, their intensities must correlate.
///
/// The surfaces are those of the map, which the mapper averaged over many frames: nothing here
/// depends on what is usual for a camera.
class LoopVerifier {
 public:
  struct Config {
    RegistrationConfig registration;
    Evidence evidence = LossRule::Config{}.found_anew;
    /// Where other loops say that it is the same place.
    Evidence expected = LossRule::Config{}.following;
    /// Both directions agree within so many standard deviations of their difference, and a voxel.
    double max_disagreement_sigmas = 3.0;
    double min_correlation = 0.5;  ///< of intensities, as for relocalisation
    /// Largest distance between the pose from features and the registered one: a feature is found
    /// within 3 pixels at a focal length of 525, which at the far end of a room, 6 m, are 3.4 cm.
    double feature_distance_m = 0.1;
    double feature_angle_rad = 0.1;
    double voxel_m = 4.5 / 512;  ///< of the map

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument if the configuration is not valid
  explicit LoopVerifier(const Config& config);

  /// The registration starts from the pose that features give, or else from `X_EL_start`. `noise`:
  /// of the camera's depth. Nothing if this is not shown to be the same place.
  std::optional<KeyframeMatch> match(const Keyframe& later, const Keyframe& earlier,
                                     const Pose& X_EL_start, const DepthNoise& noise) const;

  /// Where the later keyframe's surface fits that of the earlier one, if other loops put it at
  /// `X_EL_expected`: as a frame that continues the camera's motion must fit. Nothing if it does
  /// not.
  std::optional<KeyframeMatch> match_expected(const Keyframe& later, const Keyframe& earlier,
                                              const Pose& X_EL_expected,
                                              const DepthNoise& noise) const;

 private:
  std::optional<Registration> registered(const SurfacePyramid& frame, const SurfacePyramid& model,
                                         const Pose& X_MF_start, const Evidence& needed) const;

  Config config_;
};

}  // namespace kintsugi::mapper
