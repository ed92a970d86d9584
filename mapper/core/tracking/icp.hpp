#pragma once
// One linearisation of frame-to-model registration: point-to-plane ICP with projective association.
//
// Frames: C the camera of the new frame, V the virtual camera from which the model was raycast.

#include <Eigen/Core>
#include <cstdint>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/kernels/kernels.hpp"

namespace kintsugi::mapper {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Which pairs of a frame point and a model point are believed.
struct IcpGates {
  double max_distance_m = 0.1;     ///< between the two points
  double min_normal_cosine = 0.8;  ///< between the two normals
};

/// How the depths of a frame agree with those of the model along the model's rays, whatever the
/// gates say. A pixel counts where its point falls on a model pixel that has a depth.
struct SurfaceAgreement {
  std::int64_t overlap = 0;   ///< pixels that count
  std::int64_t behind = 0;    ///< of these: farther than the model's surface, through it
  std::int64_t in_front = 0;  ///< of these: nearer than the model's surface

  /// Farther or nearer by more than this many sigma of the depth, and at least this far.
  static constexpr double kSigmas = 3.0;
  static constexpr double kDistance_m = 0.02;
};

/// Gauss-Newton system of the weighted point-to-plane error
///   E(X_VC) = sum_i w_i (n_i . (m_i - X_VC p_i))^2,   w_i = 1 / sigma(z_i)^2
/// for the left increment X_VC <- se3_exp(xi) X_VC with xi = (translation m, rotation rad):
/// A xi = b.
struct NormalEquations {
  Matrix6d A = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  double weighted_squares = 0.0;    ///< E, dimensionless
  double squared_residuals_m2 = 0;  ///< sum of r_i^2 without weights
  std::int64_t inliers = 0;         ///< pairs that passed the gates
  SurfaceAgreement agreement;
};

/// Standard deviation of a structured-light camera's depth at depth z (metres), after Nguyen et al.
/// 2012: 0.0012 + 0.0019 (z - 0.4)^2 metres.
inline constexpr double kDepthSigmaBase_m = 0.0012;
inline constexpr double kDepthSigmaGrowth_per_m = 0.0019;
inline constexpr double kDepthSigmaNearest_m = 0.4;
inline double depth_sigma_m(double z_m) {
  const double from_nearest_m = z_m - kDepthSigmaNearest_m;
  return kDepthSigmaBase_m + kDepthSigmaGrowth_per_m * from_nearest_m * from_nearest_m;
}

/// exp of the twist (translation, rotation vector) up to the translation, which is taken as it is:
/// a retraction with the exponential map's first derivative at zero.
Pose se3_retract(const Vector6d& xi);

/// Associates each point of `frame_C` with the model pixel it projects to under `X_VC` and sums up
/// the system. It is summed in single precision over bands of rows, these in double and in fixed
/// order: the result does not depend on the number of threads or on the instruction set. Pixels
/// that are NaN on either side take no part.
NormalEquations linearize(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC,
                          const IcpGates& gates, const Kernels& kernels = best_kernels());

}  // namespace kintsugi::mapper
