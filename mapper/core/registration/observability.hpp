#pragma once
// Which directions of the camera's motion a registration determines.
//
// A registration sums rows J_i = [a_i, p_i x a_i] over pairs, with a_i a measured direction: the
// model's normal for depth, the gradient of the image for colour. Their information on a motion xi
// is xi' A xi with A = sum_i w_i J_i J_i'. But a_i is noisy: in front of a bare wall the scatter of
// the normals alone gives A full rank, many standard deviations above zero.
//
// The other side of a pair measures the same direction with noise of its own, J'_i. In
//   C = sum_i w_i (J_i J'_i' + J'_i J_i') / 2
// the two noises average out, so that C estimates the information without bias. The ratio
//   rho(xi) = xi' C xi / xi' (A + P) xi,
// is the reliability ratio of errors-in-variables regression (Fuller, Measurement Error Models,
// 1987, 1.1), 1 for a perfect measurement and 0 for noise; it is also the share of an error that
// one Gauss-Newton step removes. P is the information of what is known without a registration, so
// that a direction on which no pair has information has rho = 0. The extrema of rho are the
// eigenvalues of C v = rho (A + P) v: no scale between metres and radians has to be chosen.

#include "lcmtypes/geometry.hpp"
#include "mapper/core/registration/icp.hpp"
#include "mapper/core/registration/information.hpp"
#include "mapper/core/registration/twist.hpp"

namespace kintsugi::mapper {

/// A space of motions, split into the determined directions and the others.
struct ObservableSplit {
  TwistBasis determined = Matrix6d::Identity();
  TwistBasis open = TwistBasis(6, 0);
  double least_reliability = 1.0;  ///< smallest rho in the space; 1 if the space is empty
  double least_determined = 1.0;   ///< of the determined directions; 1 if there are none
};

struct ObservabilityConfig {
  /// Smallest rho of a determined direction. Steps remove at least this share of an error.
  double min_reliability = 0.125;
  double prior_m = 0.003;    ///< standard deviation of the predicted position,
  double prior_rad = 0.003;  ///< and of the predicted orientation
  /// Directions that depth alone does not determine may be less certain than the prediction: their
  /// deviation is at most this, in units of the prior's. The surfaces of both frames then still lie
  /// within half of the truncation distance of each other.
  double sufficient_priors = 5.0;
  /// Least share of depth's information on a direction, not determined by depth alone, that is no
  /// noise of the normals. The noise of an image scatters rho by far less.
  double min_purity = 0.2;

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// Scales an image's information to that of kIndependentPatches independent measurements, because
/// the errors of neighbouring pixels are correlated.
Information independent(const Information& information, std::size_t num_pixels);

/// Splits the span of `space` (its columns): `determined` has the eigenvectors with rho at least
/// min_reliability, `open` the others; each scaled to xi' (A + P) xi = 1.
ObservableSplit split_observable(const Information& information, const TwistBasis& space,
                                 const ObservabilityConfig& config);

/// What depth knows of the directions in a space although it does not determine them.
struct PureInformation {
  Matrix6d information = Matrix6d::Zero();  ///< without the part that is noise of the normals
  /// Square root of the share of the information that is no noise: W' A W is that part of A.
  Matrix6d weighting = Matrix6d::Zero();
};

/// Directions of which less than min_purity is no noise are left out altogether.
PureInformation pure_information(const Information& information, const TwistBasis& space,
                                 const ObservabilityConfig& config);

/// The information of point-to-plane pairs, as linearize() forms them, on the left increment of
/// X_VC. Pixels count as independent: see independent().
Information geometric_information(const SurfaceMap& frame_C, const SurfaceMap& model_V,
                                  const Pose& X_VC, const IcpGates& gates);

}  // namespace kintsugi::mapper
