#pragma once
// How far a pose is from the true one, for things that look the same when they are turned.

#include <Eigen/Core>
#include <vector>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::segmenter {

/// A turn about a line through the centre that leaves the thing as it is.
struct SymmetryAxis {
  Eigen::Vector3d direction_G = Eigen::Vector3d::UnitZ();  ///< unit vector
  int order = 2;                                           ///< by 360 degrees / order; 0: any angle
};

/// Axes that are parallel or perpendicular to each other; none: not symmetric.
struct Symmetry {
  Eigen::Vector3d centre_G = Eigen::Vector3d::Zero();  ///< metres
  std::vector<SymmetryAxis> axes;
};

struct PoseError {
  double translation_m = 0.0;  ///< of the centre
  /// To the nearest of the poses that look alike; NaN: not known.
  double rotation_deg = 0.0;
};

/// Of the estimated pose of a thing's frame G against the true one, both in one frame W.
PoseError pose_error(const Pose& X_WG_estimate, const Pose& X_WG_true, const Symmetry& symmetry);

}  // namespace kintsugi::segmenter
