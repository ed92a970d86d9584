#pragma once
// One linearisation of frame-to-model registration: point-to-plane ICP with projective association.
//
// Frames: C the camera of the new frame, V the virtual camera from which the model was raycast.

#include <cstdint>
#include <optional>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/registration/twist.hpp"

namespace kintsugi::mapper {

/// Which pairs of a frame point and a model point are inliers.
struct IcpGates {
  /// The two points are at most sqrt(max_distance_m^2 + (max_distance_sigmas sigma(z))^2) apart:
  /// by the motion that the prediction missed, and by the noise.
  double max_distance_m = 0.1;
  double max_distance_sigmas = 3.0;
  double min_normal_cosine = 0.8;  ///< between the two normals
};

/// How far a residual r, in deviations of its depth, counts: fully up to full_sigmas, then less and
/// less, from none_sigmas not at all,
///   psi(r) = sign(r) min(|r|, full (none - |r|) / (none - full)), 0 for |r| > none
/// (Hampel 1974, without a flat part). The noise of a depth is hardly ever larger than full_sigmas.
/// What is farther off is surface that the model has in a wrong place, such as the edge of a door
/// that was seen from the other side only; near the camera a few such pixels weigh more than all
/// that is far away.
struct InfluenceLimits {
  double full_sigmas = 3.0;
  double none_sigmas = 9.0;
};

/// How the depths of a frame agree with those of the model along the model's rays, independently of
/// the gates. A pixel counts where its point projects onto a model pixel that has a depth.
struct SurfaceAgreement {
  std::int64_t overlap = 0;   ///< pixels that count
  std::int64_t behind = 0;    ///< of these: farther than the model's surface
  std::int64_t in_front = 0;  ///< of these: nearer than the model's surface

  /// Farther or nearer by more than kSigmas times sigma(z) and more than kDistance_m.
  static constexpr double kSigmas = 3.0;
  static constexpr double kDistance_m = 0.02;
};

/// Gauss-Newton system of the weighted point-to-plane error
///   E(X_VC) = sum_i w_i (n_i . (m_i - X_VC p_i))^2,   w_i = 1 / sigma(z_i)^2
/// for the left increment X_VC <- se3_retract(xi) X_VC with xi = (translation m, rotation rad):
/// A xi = b. With limits, b is the sum of the limited residuals' gradients, while A and E stay
/// those of all inliers: steps become shorter, but end at the same pose, and no direction loses its
/// curvature (Huber's modified residuals).
struct NormalEquations {
  Matrix6d A = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  double weighted_squares = 0.0;    ///< E, dimensionless
  double squared_residuals_m2 = 0;  ///< sum of r_i^2 without weights
  std::int64_t inliers = 0;         ///< pairs that passed the gates
  SurfaceAgreement agreement;
};

/// Associates each point of `frame_C` with the model pixel onto which it projects under `X_VC`, and
/// sums up the system: in single precision over bands of rows, then in double precision over the
/// bands in fixed order, so that the result does not depend on the number of threads or on the
/// instruction set. Pixels that are NaN on either side are left out.
NormalEquations linearize(const SurfaceMap& frame_C, const SurfaceMap& model_V, const Pose& X_VC,
                          const IcpGates& gates, const std::optional<InfluenceLimits>& limits = {},
                          const Kernels& kernels = best_kernels());

}  // namespace kintsugi::mapper
