#pragma once
// Frame-to-model tracking.
//
// Frames: W map, C camera of the new frame, V virtual camera from which the model was raycast.

#include <cstdint>
#include <optional>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/tracking_input.hpp"
#include "mapper/core/registration/model.hpp"
#include "mapper/core/registration/photometric_pyramid.hpp"
#include "mapper/core/registration/registration.hpp"
#include "mapper/core/tracking/loss_rule.hpp"
#include "mapper/core/tracking/tracking_result.hpp"

namespace kintsugi::mapper {

/// Follows the camera by registering each frame with the model, from a constant-velocity
/// prediction: point-to-plane ICP, coarse to fine. Directions of motion that the geometry in view
/// does not determine are determined by colour, against an earlier frame (the photometric
/// reference); without colour or texture they stay undetermined. A frame that the loss rule
/// rejects, that fits worse than usual, or before which the motion is unknown, is tried again from
/// the last good pose with a wide search, and the pose that fits better is taken. If that is
/// accepted, but doubts are left, a registration from the prediction with a close gate may dispel
/// them. If it is rejected, the state is kLost and the last good pose stays.
class Tracker {
 public:
  struct Config {
    RegistrationConfig registration;
    std::int64_t max_prediction_us = 500'000;  ///< no constant velocity across a longer gap
    /// For so long a lost camera is still expected to go on with its velocity: what a hand does in
    /// a third of a second, before it reverses.
    std::int64_t coast_us = 300'000;
    /// A lost camera whose motion is followed, from one frame to the next or in some directions, is
    /// expected there for so long after the last good pose: until then the error of what is not
    /// measured stays within reach of a registration.
    std::int64_t coast_partly_us = 1'500'000;
    /// m/s^2 (and rad/s^2), of a hand-held camera: a pose farther from the prediction than this
    /// explains is judged as one found anew.
    double max_acceleration = 30.0;
    /// m/s, of whatever carries the camera: a person in a hurry. Where tracking was lost for a
    /// moment, the camera cannot be in another room, however much that looks like this one. A
    /// faster camera is found later.
    double max_speed = 2.0;
    /// Largest drift, as a share of the path: dense tracking drifts by about a hundredth. A place
    /// that is found again may be so far from where the map has it.
    double max_drift_share = 0.02;
    /// Share of a frame's pixels that are compared with the photometric reference; below it, the
    /// frame becomes the next reference.
    double min_reference_overlap = 0.6;
    /// Likewise for the reliability of the directions that the reference determines: the frames
    /// become dissimilar long before they stop overlapping.
    double min_reference_reliability = 0.7;
    LossRule::Config loss;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument if the configuration is not valid
  explicit Tracker(const Config& config);

  /// Sets the camera's pose in this frame: the first frame, or a relocalised one. The velocity is
  /// unknown afterwards. `covered_share` is that of the frame.
  void start_at(const Pose& X_WC, const TrackingInput& frame, double covered_share);

  /// Registers a frame with the model. Both pyramids have as many levels as the configuration.
  /// After a loss the tracker keeps the last good pose and may be called with the next frame.
  TrackingResult track(const TrackingInput& frame, const Model& model);

  /// Registers a frame, by depth alone, from a pose that may be wrong: by a wide search, and
  /// accepted (kTracking) only as a pose found anew. Does not change the tracker.
  TrackingResult register_anew(const TrackingInput& frame, const Model& model,
                               const Pose& X_WC_start) const;

  /// Goes on in another frame N of the map, with the same velocity and reference.
  void change_frame(const Pose& X_NW);

  /// The pose at this device time (microseconds) with constant velocity.
  Pose predict(std::int64_t utime) const;

  /// Whether the camera, which was at the last good pose, can be here at this device time
  /// (microseconds), where tracking has drifted on a way of `way_m` between the two. Before the
  /// first pose it can be anywhere. With `reach_m`: here or so near to it.
  bool can_be_at(const Pose& X_WC, std::int64_t utime, double way_m, double reach_m = 0.0) const;

  /// How far from its start register_anew() looks, metres.
  double reach_m() const {
    return config_.registration.wide_gate_factor * config_.registration.gates.max_distance_m;
  }

  /// Length of the path to the last good pose, without jumps.
  double path_m() const { return path_m_; }

  /// Whether the last frame was lost, but the camera is still expected near predict(): its model
  /// should be the map as seen from there.
  bool is_coasting(std::int64_t utime) const { return lost_ && motion_continues(utime); }

 private:
  /// A pose, and why it is rejected; nothing if it is accepted.
  struct Judged {
    Registration registration;
    std::optional<LossReason> loss;
  };

  bool motion_continues(std::int64_t utime) const;
  Judged register_by_motion(const TrackingInput& frame, const Model& model,
                            const PhotometricPair& colors) const;
  Judged register_closely(const TrackingInput& frame, const Model& model,
                          const PhotometricPair& colors) const;
  Judged judge_by_motion(const Registration& registration, std::int64_t utime) const;
  Judged register_widely(const TrackingInput& frame, const Model& model,
                         const PhotometricPair& colors) const;
  Judged search_further(const Judged& by_motion, const TrackingInput& frame, const Model& model,
                        const PhotometricPair& colors) const;
  bool is_doubtful(const Judged& by_motion) const;
  Judged better_of(const Judged& by_motion, const Judged& wide, const TrackingInput& frame) const;
  static bool replaces(const Judged& other, const Judged& first);
  bool needs_new_reference(const Registration& registration) const;
  void update_reference(const Registration& registration, PhotometricPyramid frame);
  bool follows_motion(const Registration& registration, std::int64_t utime) const;
  TrackingResult accept(const Registration& registration, const TrackingInput& frame);
  void follow_partly(const Registration& registration, std::int64_t utime);
  void follow_last_frame(const TrackingInput& frame);
  TrackingResult lose(const Registration& registration, LossReason reason);

  Config config_;
  LossRule loss_rule_;
  Pose X_WC_ = Pose::Identity();  ///< last good
  bool has_pose_ = false;
  double path_m_ = 0.0;     ///< see path_m()
  std::int64_t utime_ = 0;  ///< of the last good pose
  /// From which predict() goes on: the last good pose or, after it, one that was determined but for
  /// some directions, in which it is predicted.
  Pose X_WC_followed_ = Pose::Identity();
  std::int64_t utime_followed_ = 0;
  Vector6d velocity_C_ = Vector6d::Zero();  ///< m/s, rad/s: X_WC(t + dt) = X_WC retract(v dt)
  bool motion_known_ = false;               ///< velocity_C_ was measured
  bool lost_ = false;
  std::optional<PhotometricReference> reference_;  ///< none without colour
  std::optional<Model> last_frame_;                ///< its own surface, if it was followed
};

}  // namespace kintsugi::mapper
