#pragma once
// How well does a registration determine the camera's pose?

#include "lcmtypes/geometry.hpp"
#include "mapper/core/tracking/icp.hpp"

namespace kintsugi::mapper {

/// Standard deviation, in its worst direction, of where the pose X_VC puts the camera or the point
/// 1 m before it, the larger one; metres. Infinite where a direction is open.
///
/// The covariance of a point p_V under a left increment of the pose is J A^-1 J^T with
/// J = [I, -[p]x]. A (of NormalEquations) takes residuals as independent, but depth errors of
/// neighbouring pixels and of the model behind them go together: only about `kIndependentPatches`
/// of an image are independent, whatever its number of pixels.
double pose_sigma_m(const Matrix6d& A, const Pose& X_VC, int num_pixels);

/// Errors of poses measured on views cut down to a quarter were 10 to 30 times A's own estimate at
/// 320x240: as if patches of 20x20 pixels were one measurement each.
inline constexpr double kIndependentPatches = 192.0;

}  // namespace kintsugi::mapper
