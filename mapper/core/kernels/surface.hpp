#pragma once
// The inner loops that make surfaces from depth images and halve them (see surface_pyramid.hpp).

#include <cstdint>

#include "mapper/core/kernels/surface_planes.hpp"

namespace kintsugi::mapper {

/// A row of a depth image of half the size, `width` pixels, from the two above it. Depths beyond
/// `max_depth_m` are invalid.
using HalveDepthRow = void (*)(const float* upper_m, const float* lower_m, float max_depth_m,
                               int width, float* half_m);

/// Row `v` of the normals, from the depths.
using NormalsRow = void (*)(const MutableSurfacePlanes& surface, int v);

/// Row `v` of a surface of half the size.
using HalveSurfaceRow = void (*)(const SurfacePlanes& fine, int v,
                                 const MutableSurfacePlanes& half);

/// Points of a row that lie in a box.
struct BoxCount {
  SurfacePlanes frame_C;
  RigidMotion X_WC;
  float min_W[3] = {};
  float max_W[3] = {};
};
using CountInBox = std::int32_t (*)(const BoxCount& input, int v);

}  // namespace kintsugi::mapper
