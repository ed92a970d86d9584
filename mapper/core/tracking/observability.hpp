#pragma once
// Which directions of the camera's motion does a registration determine?
//
// A registration sums rows J_i = [a_i, p_i x a_i] over pairs, with a_i a measured direction: the
// model's normal for depth, the gradient of the image for colour. Their information on a motion xi
// is xi' A xi with A = sum_i w_i J_i J_i'. But a_i is noisy, and noise informs about nothing:
// before a bare wall the normals' scatter alone gives A full rank, many standard deviations above
// zero.
//
// The other side of a pair measures the same direction with noise of its own, J'_i. In
//   C = sum_i w_i (J_i J'_i' + J'_i J_i') / 2
// the two noises average out: C estimates the information without bias. What is left of it,
//   rho(xi) = xi' C xi / xi' (A + P) xi,
// is the reliability ratio of errors-in-variables regression (Fuller, Measurement Error Models,
// 1987, 1.1), 1 for a perfect measurement and 0 for noise; it is also the share of an error that
// one Gauss-Newton step removes. P is the information of what is known without a registration, so
// that a direction no pair says anything about has rho = 0. The extrema of rho are the eigenvalues
// of C v = rho (A + P) v: no scale between metres and radians has to be chosen.

#include <Eigen/Core>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/tracking/icp.hpp"

namespace kintsugi::mapper {

/// Directions of motion: each column a twist (translation in metres, rotation in radians), columns
/// independent; none to six.
using TwistBasis = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

/// A and C of the above.
struct Information {
  Matrix6d A = Matrix6d::Zero();
  Matrix6d C = Matrix6d::Zero();
};

/// A space of motions, split.
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

  /// @throws std::invalid_argument naming field, value and bound
  void validate() const;
};

/// What an image's information comes to when its pixels' errors hold over patches, of which there
/// are kIndependentPatches, whatever the number of pixels.
Information independent(const Information& information, std::size_t num_pixels);

/// Splits the span of `space` (its columns): `determined` has the eigenvectors with rho at least
/// min_reliability, `open` the others; each scaled to xi' (A + P) xi = 1.
ObservableSplit split_observable(const Information& information, const TwistBasis& space,
                                 const ObservabilityConfig& config);

/// The information of point-to-plane pairs, as linearize() forms them, on the left increment of
/// X_VC. Pixels are taken as independent, which they are not: see independent().
Information geometric_information(const SurfaceMap& frame_C, const SurfaceMap& model_V,
                                  const Pose& X_VC, const IcpGates& gates);

}  // namespace kintsugi::mapper
