#pragma once
// Poses and camera intrinsics, as all processes use them.
//
// Frames: W map, C depth camera (x right, y down, z forward), V virtual camera.
// X_AB is the pose of B in A: p_A = X_AB * p_B.

#include <Eigen/Geometry>
#include <array>

namespace kintsugi {

using Pose = Eigen::Isometry3d;

/// Coordinates of a pose may be as large as this: a map of the whole of a country.
inline constexpr double kMaxPosition_m = 1e6;

/// A calibrated camera: a pinhole with the Brown-Conrady lens distortion of OpenCV.
///
/// A pixel (u, v) with depth z (metres along C's z) is the point
///   p_C = (z (u - cx) / fx, z (v - cy) / fy, z)
/// when `distortion` is zero; integer coordinates are pixel centres.
struct Intrinsics {
  double fx = 0.0;                     ///< focal length along u, pixels, > 0
  double fy = 0.0;                     ///< focal length along v, pixels, > 0
  double cx = 0.0;                     ///< principal point, pixels
  double cy = 0.0;                     ///< principal point, pixels
  int width = 0;                       ///< pixels, > 0
  int height = 0;                      ///< pixels, > 0
  std::array<double, 5> distortion{};  ///< k1 k2 p1 p2 k3, dimensionless; all zero: none

  bool operator==(const Intrinsics&) const = default;
};

}  // namespace kintsugi
