#pragma once

#include "lcmtypes/geometry.hpp"
#include "mapper/core/registration/twist.hpp"

namespace kintsugi::mapper {

/// Two keyframes that show the same place, though the camera came back to it by another way: the
/// map knew nothing of the earlier surface any more when the later keyframe was taken.
struct Loop {
  int later = 0;    ///< number of a keyframe, L
  int earlier = 0;  ///< number of a keyframe, E
  Pose X_EL = Pose::Identity();
  Matrix6d information_L = Matrix6d::Zero();  ///< of a right increment of X_EL, see Registration
  double sigma_m = 0.0;                       ///< uncertainty of X_EL, see pose_sigma_m()
};

/// The camera, seen from two keyframes: it was tracked near one of them, and found by the surface
/// of another one.
struct SharedView {
  int tracked_near = 0;  ///< number of a keyframe, T
  Pose X_TC = Pose::Identity();
  int found_by = 0;  ///< number of a keyframe, F
  Pose X_FC = Pose::Identity();
  Matrix6d information_C = Matrix6d::Zero();  ///< of a right increment of X_FC, see Registration
  double sigma_m = 0.0;                       ///< uncertainty of X_FC, see pose_sigma_m()
};

}  // namespace kintsugi::mapper
