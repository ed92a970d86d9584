#pragma once

#include "mapper/core/kernels/pinhole_camera.hpp"

namespace kintsugi::mapper {

/// Pointers to the images of a SurfaceMap (see surface_map.hpp): four planes of the camera's size,
/// without padding between rows; NaN is invalid.
template <typename Number>
struct Planes {
  Number* depth_m = nullptr;
  Number* normal_x = nullptr;
  Number* normal_y = nullptr;
  Number* normal_z = nullptr;
  PinholeCamera camera;
};
using SurfacePlanes = Planes<const float>;
using MutableSurfacePlanes = Planes<float>;

/// X_BA: p_B = R p_A + t; R by rows, t in metres.
struct RigidMotion {
  float R[3][3] = {};
  float t[3] = {};
};

}  // namespace kintsugi::mapper
