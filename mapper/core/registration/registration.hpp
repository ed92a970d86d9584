#pragma once
// Registers a frame with a model, coarse to fine.
//
// Frames: W map, C camera of the frame, V virtual camera from which the model was raycast.

#include <vector>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/tracking_input.hpp"
#include "mapper/core/registration/icp.hpp"
#include "mapper/core/registration/model.hpp"
#include "mapper/core/registration/photometric_pyramid.hpp"
#include "mapper/core/registration/registration_quality.hpp"
#include "mapper/core/registration/step_solver.hpp"

namespace kintsugi::mapper {

struct RegistrationConfig {
  std::vector<int> iterations = {5, 5, 4};  ///< at most, per level, finest first
  IcpGates gates;
  /// At the finest level after a coarser one: the pose is nearly right already, and what does not
  /// fit then is no motion.
  InfluenceLimits influence;
  double early_exit = 3e-5;  ///< norm of the increment (m, rad) at the finest level, x2 a level
  /// On max_distance_m, at the coarsest level of a wide search: how far that looks, also sideways.
  double wide_gate_factor = 3.0;
  int wide_iteration_factor = 3;  ///< on the iterations of the coarsest level of a wide search
  /// max_distance_m is divided by this in a close registration: a prediction is no farther off.
  double close_gate_factor = 3.0;
  StepSolver::Config steps;

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// The result of a registration.
struct Registration {
  Pose X_WC = Pose::Identity();
  RegistrationQuality quality;
  int iterations = 0;
  /// Inverse covariance of a right increment of X_WC, a twist in C (1/m^2, 1/rad^2); see
  /// pose_uncertainty.hpp.
  Matrix6d information_C = Matrix6d::Zero();
  TwistBasis open_to_depth_C = TwistBasis(6, 0);  ///< directions that depth does not determine
  TwistBasis undetermined_C = TwistBasis(6, 0);   ///< of these, the ones that colour leaves open
  double compared_share = 1.0;                    ///< see Step, as of the last step
  double photometric_reliability = 1.0;           ///< see Step, as of the last step
};

/// Registers from a pose near the camera's. The pyramids of the frame and of the model have as many
/// levels as the configuration.
Registration register_frame(const TrackingInput& frame, const Model& model,
                            const PhotometricPair& colors, const Pose& X_WC_start,
                            const RegistrationConfig& config);

/// The same, but from the other start if the frame fits much better from there at the coarsest
/// level.
Registration register_frame(const TrackingInput& frame, const Model& model,
                            const PhotometricPair& colors, const Pose& X_WC_start,
                            const Pose& X_WC_other_start, const RegistrationConfig& config);

/// The same, but from a pose that is hardly off, with a close distance gate: what stands near to
/// the surface that a pixel shows does not draw the pose away.
Registration register_frame_closely(const TrackingInput& frame, const Model& model,
                                    const PhotometricPair& colors, const Pose& X_WC_start,
                                    const RegistrationConfig& config);

/// Registers from a pose that may be farther off: the coarsest level with a wider distance gate and
/// more iterations, and then as register_frame() from the pose found. Along the motion of which the
/// surfaces tell least (along a wall) few pixels say where the camera is, and only when it is near:
/// so the coarsest level is solved from poses on both sides along it, too, and registration goes on
/// from the one that is supported most.
Registration register_frame_widely(const TrackingInput& frame, const Model& model,
                                   const PhotometricPair& colors, const Pose& X_WC_start,
                                   const RegistrationConfig& config);

}  // namespace kintsugi::mapper
