#pragma once
// A Gauss-Newton step of registration: by depth in the directions that depth determines, by colour
// in the others, and zero in those that neither determines.

#include <optional>

#include "mapper/core/registration/icp.hpp"
#include "mapper/core/registration/observability.hpp"
#include "mapper/core/registration/photometric.hpp"
#include "mapper/core/registration/photometric_pyramid.hpp"

namespace kintsugi::mapper {

struct Step {
  Vector6d xi = Vector6d::Zero();  ///< left increment of X_VC
  /// Directions of the left increment that neither depth nor colour determines.
  TwistBasis undetermined = TwistBasis(6, 0);
  /// Information of the intensities; zero where they were not used.
  Matrix6d photometric_information = Matrix6d::Zero();
  /// Share of the frame's pixels whose intensity was compared; 1 where intensities were not used.
  double compared_share = 1.0;
  /// Smallest reliability (see observability.hpp) of the directions that colour determines; 1 where
  /// there are none.
  double photometric_reliability = 1.0;
};

/// Computes the steps of one registration of a frame with a model (V) and, by colour, with a
/// reference frame (K).
///
/// With V_o a basis of the directions that depth determines and V_d one of the rest, the increment
/// is x = V_o y_o + V_d y_d:
///   (V_o' A V_o) y_o = V_o' b                       of the point-to-plane system A, b alone,
///   (V_d' H V_d) y_d = V_d' (g - H V_o y_o)         of the photometric system H, g.
/// y_d is zero in the directions of V_d that the photometric system does not determine: there the
/// predicted pose stays. Where depth determines all directions, colour is not used.
class StepSolver {
 public:
  struct Config {
    ObservabilityConfig observability;
    PhotometricConfig photometric;
  };

  /// `colors` refers to frames with colour that outlive the solver.
  StepSolver(const PhotometricPair& colors, const Pose& X_WV, const Config& config)
      : colors_(colors), X_WV_(X_WV), config_(config) {}

  /// Decides which directions depth determines in the following steps.
  void observe(const Information& geometric);

  /// The increment of X_VC at a level of the pyramids; nothing if the equations have no solution.
  std::optional<Step> solve(const NormalEquations& geometric, int level, const Pose& X_VC);

  /// Directions of the left increment of X_VC that depth does not determine.
  const TwistBasis& open_to_depth() const { return geometry_.open; }

 private:
  void add_photometric_part(int level, const Pose& X_VC, Step& step);

  PhotometricPair colors_;
  Pose X_WV_;
  Config config_;
  ObservableSplit geometry_;
  std::optional<Exposure> exposure_;  ///< as of the step before
};

}  // namespace kintsugi::mapper
