#pragma once
// A SurfaceMap as the kernels want it.

namespace kintsugi::mapper {

/// A camera without distortion.
struct PinholeCamera {
  int width = 0;
  int height = 0;
  float fx = 0.0F;
  float fy = 0.0F;
  float cx = 0.0F;
  float cy = 0.0F;
  float inverse_fx = 0.0F;
  float inverse_fy = 0.0F;
};

/// Four planes of the camera's size, without padding between rows; NaN is invalid.
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

/// p_B = R_BA p_A + t_BA; the matrix by rows, metres.
struct RigidMotion {
  float R[3][3] = {};
  float t[3] = {};
};

}  // namespace kintsugi::mapper
