#pragma once
// A Gauss-Newton step of registration: by depth in the directions that depth determines, by colour
// in the others, and none at all in those that neither determines.

#include <optional>

#include "mapper/core/tracking/icp.hpp"
#include "mapper/core/tracking/observability.hpp"
#include "mapper/core/tracking/photometric.hpp"
#include "mapper/core/tracking/photometric_view.hpp"

namespace kintsugi::mapper {

/// For one registration of a frame with a model (V) and, by colour, with a keyframe (K).
///
/// With V_o a basis of the directions that depth determines and V_d one of the rest, the increment
/// is x = V_o y_o + V_d y_d:
///   (V_o' A V_o) y_o = V_o' b                       of the point-to-plane system A, b alone,
///   (V_d' H V_d) y_d = V_d' (g - H V_o y_o)         of the photometric system H, g.
/// In what of V_d the photometric system determines neither, y_d is zero: the prediction stands.
/// Where depth determines everything, colour is not looked at.
class StepSolver {
 public:
  struct Config {
    ObservabilityConfig observability;
    PhotometricConfig photometric;
  };

  /// `frame_C` and `keyframe`: views with colour, to outlive the solver; if one is null, depth
  /// alone decides.
  StepSolver(PhotometricView* frame_C, Keyframe* keyframe, const Pose& X_WV, const Config& config)
      : frame_(frame_C), keyframe_(keyframe), X_WV_(X_WV), config_(config) {}

  /// Decides from now on which directions depth determines.
  void observe(const Information& geometric);

  /// The increment of X_VC at a level of the pyramids; nothing if the equations have no solution.
  std::optional<Vector6d> solve(const NormalEquations& geometric, int level, const Pose& X_VC);

  /// Directions of the left increment of X_VC that depth leaves open, and what colour leaves of
  /// these as of the last step.
  const TwistBasis& open_to_depth() const { return geometry_.open; }
  const TwistBasis& undetermined() const { return undetermined_; }

  /// Of the last step: the colour's information, zero where it was not looked at, and the share of
  /// the frame's pixels that were compared with the keyframe, 1 if there was no need to.
  const Matrix6d& photometric_information() const { return photometric_information_; }
  double compared_share() const { return compared_share_; }
  /// Of the last step: the least reliability with which colour decides one of the directions that
  /// it decides; 1 if it decides none.
  double photometric_reliability() const { return photometric_reliability_; }

 private:
  Vector6d photometric_part(const Vector6d& geometric_part, int level, const Pose& X_VC);

  PhotometricView* frame_;
  Keyframe* keyframe_;
  Pose X_WV_;
  Config config_;
  ObservableSplit geometry_;
  TwistBasis undetermined_ = TwistBasis(6, 0);
  std::optional<Exposure> exposure_;
  Matrix6d photometric_information_ = Matrix6d::Zero();
  double compared_share_ = 1.0;
  double photometric_reliability_ = 1.0;
};

}  // namespace kintsugi::mapper
