#pragma once
// Makes surfaces from depth images, row by row: the innermost loops of surface_pyramid.hpp and
// covered_share.hpp.

#include <cstdint>

#include "mapper/core/kernels/depth_variance.hpp"
#include "mapper/core/kernels/surface_planes.hpp"

namespace kintsugi::mapper {

/// Two depths, `steps` pixels apart, may lie on the same surface if they differ by at most
///   kSigmas sqrt(2) sigma(z) + kSlope steps z / f,
/// what the noise of both and a surface that is inclined by 76 degrees to the image explain.
struct DepthTolerance {
  static constexpr float kSigmas = 4.0F;
  static constexpr float kSlope = 4.0F;
  DepthVariance variance;
  float slope = 0.0F;  ///< kSlope / f
};

/// Pixels around an image that SmoothDepthRow reads: the half width of its window.
inline constexpr int kSmoothingReach_px = 2;

/// Computes row `v` of a smoothed depth image, `width` pixels: each depth is the mean of those in
/// the window of 5x5 pixels around it that lie on the same surface. `padded_m` is the depth image
/// with kSmoothingReach_px invalid pixels added on each side.
using SmoothDepthRow = void (*)(const float* padded_m, int width, int v,
                                const DepthTolerance& tolerance, float* smooth_m);

/// Computes one row of a depth image of half the size, `width` pixels, from two rows of the larger
/// one. Depths beyond `max_depth_m` are invalid. The tolerance is that of the larger image.
using HalveDepthRow = void (*)(const float* upper_m, const float* lower_m, float max_depth_m,
                               const DepthTolerance& tolerance, int width, float* half_m);

/// Computes row `v` of the normals from `depth_m`, which may be a smoothed image.
using NormalsRow = void (*)(const float* depth_m, const DepthTolerance& tolerance, int v,
                            const MutableSurfacePlanes& surface);

/// Computes row `v` of a surface of half the size. The tolerance is that of the larger one.
using HalveSurfaceRow = void (*)(const SurfacePlanes& fine, const DepthTolerance& tolerance, int v,
                                 const MutableSurfacePlanes& half);

struct BoxCount {
  SurfacePlanes frame_C;
  RigidMotion X_WC;
  float min_W[3] = {};
  float max_W[3] = {};
};
/// Counts the points of row `v` that lie in the box.
using CountInBox = std::int32_t (*)(const BoxCount& input, int v);

}  // namespace kintsugi::mapper
