#pragma once
// How well a registration determines the camera's pose.

#include "lcmtypes/geometry.hpp"
#include "mapper/core/registration/twist.hpp"

namespace kintsugi::mapper {

/// Standard deviation, in its worst direction, of the position of the camera and of the point 1 m
/// in front of it, whichever is larger; metres. Infinite where a direction is not determined.
///
/// The covariance of a point p_V under a left increment of the pose is J A^-1 J^T with
/// J = [I, -[p]x]. A (of NormalEquations) takes residuals as independent, but the depth errors of
/// neighbouring pixels, and of the model behind them, are correlated: an image has only about
/// `kIndependentPatches` independent measurements, whatever its number of pixels.
double pose_sigma_m(const Matrix6d& A, const Pose& X_VC, int num_pixels);

/// The inverse of the covariance of pose_sigma_m(), of a right increment of X_VC: a twist in C.
Matrix6d information_of_pose(const Matrix6d& A, const Pose& X_VC, int num_pixels);

/// The errors of poses, measured on views reduced to a quarter, were 10 to 30 times the estimate of
/// A at 320x240: as if each patch of 20x20 pixels were one measurement.
inline constexpr double kIndependentPatches = 192.0;

}  // namespace kintsugi::mapper
