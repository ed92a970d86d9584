#pragma once
// Frame-to-model tracking.
//
// Frames: W map, C camera of the new frame, V virtual camera from which the model was raycast.

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"
#include "mapper/core/frame/surface_pyramid.hpp"
#include "mapper/core/tracking/icp.hpp"
#include "mapper/core/tracking/loss_rule.hpp"
#include "mapper/core/tracking/observability.hpp"
#include "mapper/core/tracking/photometric_view.hpp"
#include "mapper/core/tracking/step_solver.hpp"

namespace kintsugi::mapper {

/// What is known of the map: its surface as seen from a pose near the camera's.
struct Model {
  SurfacePyramid surface_V;
  Pose X_WV = Pose::Identity();
  /// Where the map can be at all, metres: frame points outside are no evidence for or against.
  Eigen::AlignedBox3d region_W{Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity()),
                               Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())};
};

/// One frame as the tracker takes it.
struct TrackingInput {
  std::int64_t utime = 0;         ///< device time, microseconds
  SurfacePyramid surface_C;       ///< of its depth
  cv::Mat_<cv::Vec3b> color_rgb;  ///< of the same view; 1, 2, 4.. times the finest surface's width
                                  ///< and height; or empty. Shared, not copied: nobody may write it
};

struct TrackingResult {
  TrackingState state = TrackingState::kStarting;
  Pose X_WC = Pose::Identity();  ///< the last good pose when state is kLost
  RegistrationQuality quality;
  int iterations = 0;
  std::optional<LossReason> loss_reason;  ///< set when state is kLost
  TwistBasis open_to_depth_C;             ///< directions of motion that geometry leaves open
  TwistBasis undetermined_C;              ///< what colour leaves open of those: if any, it is lost
};

/// Follows the camera by registering each frame with the model: point-to-plane ICP, coarse to fine,
/// from a constant-velocity prediction. Directions that the geometry in view leaves open are
/// decided by colour, against a frame seen before; where there is no colour, or no texture, they
/// stay undetermined. A frame that the loss rule does not believe is tried again from the last good
/// pose with wider gates; then the state is kLost and the last pose stands.
class Tracker {
 public:
  struct Config {
    std::vector<int> iterations = {5, 5, 4};  ///< at most, per level, finest first
    IcpGates gates;
    double early_exit = 3e-5;  ///< norm of the increment (m, rad) at the finest level, x2 a level
    double retry_gate_factor = 3.0;  ///< on max_distance_m, at the coarsest level of a retry
    int retry_iteration_factor = 3;  ///< on the coarsest level's iterations in a retry
    std::int64_t max_prediction_us = 500'000;  ///< no constant velocity across a longer gap
    /// A hand's, m/s^2 (and rad/s^2): poses further from the prediction than it explains must fit
    /// as well as poses found anew.
    double max_acceleration = 30.0;
    StepSolver::Config steps;
    double min_keyframe_overlap = 0.6;  ///< of a frame with the keyframe; below, it is the next one
    double min_keyframe_reliability = 0.7;  ///< likewise of what the keyframe decides: it grows
                                            ///< unlike the view long before it leaves it
    LossRule::Config loss;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument if the configuration is not valid
  explicit Tracker(const Config& config);

  /// The camera is known to be at `X_WC` in this frame: the first one, or a relocalised one. Motion
  /// starts anew. `covered_share` is that of the frame.
  void start_at(const Pose& X_WC, const TrackingInput& frame, double covered_share);

  /// Registers a frame with the model. Both pyramids have as many levels as the configuration.
  /// After a loss the tracker keeps the last good pose and may be called with the next frame.
  TrackingResult track(const TrackingInput& frame, const Model& model);

  /// Registers a frame from a place where it may not be at all: wide gates, believed (kTracking)
  /// only if it fits as a pose found anew must, by depth alone. What the tracker knows of the path
  /// stays as it is.
  TrackingResult register_anew(const TrackingInput& frame, const Model& model,
                               const Pose& X_WC_start) const;

  /// Where constant velocity (device time in microseconds) puts the camera.
  Pose predict(std::int64_t utime) const;

 private:
  struct Registration {
    Pose X_WC = Pose::Identity();
    RegistrationQuality quality;
    NormalEquations equations;
    int iterations = 0;
    TwistBasis open_to_depth_C = TwistBasis(6, 0);
    TwistBasis undetermined_C = TwistBasis(6, 0);
    double photometric_reliability = 1.0;  ///< least, of what colour decides
    double compared_share = 1.0;  ///< of the pixels, with the keyframe; 1 if there was no need to
  };
  /// Brightness of a frame and of what it is compared with; null: depth alone.
  struct Views {
    PhotometricView* frame_C = nullptr;
    Keyframe* keyframe = nullptr;
  };

  Registration register_frame(const TrackingInput& frame, const Model& model, const Views& views,
                              const Pose& X_WC_start, bool wide) const;
  Registration register_widely(const TrackingInput& frame, const Model& model, const Views& views,
                               const Pose& X_WC_start) const;
  bool is_worn(const Registration& registration) const;
  void choose_keyframe(const Registration& registration, PhotometricView view);
  bool follows_motion(const Pose& X_WC, std::int64_t utime) const;
  TrackingResult accept(const Registration& registration, const TrackingInput& frame);
  TrackingResult lose(const Registration& registration, LossReason reason);

  Config config_;
  LossRule loss_rule_;
  Pose X_WC_ = Pose::Identity();            ///< last good
  std::int64_t utime_ = 0;                  ///< of the last good pose
  Vector6d velocity_C_ = Vector6d::Zero();  ///< m/s, rad/s: X_WC(t + dt) = X_WC retract(v dt)
  bool motion_known_ = false;               ///< velocity_C_ was measured
  bool lost_ = false;
  std::optional<Keyframe> keyframe_;  ///< what colours are compared with; none without colour
};

}  // namespace kintsugi::mapper
