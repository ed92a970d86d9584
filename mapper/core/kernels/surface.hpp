#pragma once
// Makes surfaces from depth images, row by row: the innermost loops of surface_pyramid.hpp and
// covered_share.hpp.

#include <cstdint>

#include "mapper/core/kernels/surface_planes.hpp"

namespace kintsugi::mapper {

/// Computes one row of a depth image of half the size, `width` pixels, from two rows of the larger
/// one. Depths beyond `max_depth_m` are invalid.
using HalveDepthRow = void (*)(const float* upper_m, const float* lower_m, float max_depth_m,
                               int width, float* half_m);

/// Computes row `v` of the normals from the depths.
using NormalsRow = void (*)(const MutableSurfacePlanes& surface, int v);

/// Computes row `v` of a surface of half the size.
using HalveSurfaceRow = void (*)(const SurfacePlanes& fine, int v,
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
