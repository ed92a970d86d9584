#pragma once
// Rays through the volume, for one tile of pixels at a time.

#include "mapper/core/kernels/surface_planes.hpp"
#include "mapper/core/kernels/volume_view.hpp"

namespace kintsugi::mapper {

/// Where the rays start, where the surface is expected on them and where their depths go.
struct RaycastView {
  PinholeCamera camera;
  float origin_vox[3] = {};    ///< of the camera, cube coordinates
  float vox_per_m[3][3] = {};  ///< [axis of the cube][axis of C]: R_WC / resolution_m

  const float* guide_m = nullptr;  ///< null, or depths of the same view at any size; NaN: none
  int guide_columns = 0;
  int guide_rows = 0;
  float guide_margin_m = 0.0F;  ///< rays start this much before their guide

  float* depth_m = nullptr;  ///< height x width, without padding; NaN where there is no surface
};

/// Pixels [u, u + side) x [v, v + side), as far as they are in the image, and the depths between
/// which their rays can meet a block: none where near_m > far_m.
struct RaycastTile {
  static constexpr int kSide_px = 8;
  int u = 0;
  int v = 0;
  float near_m = 0.0F;
  float far_m = 0.0F;
};

/// Writes the depths of the tile's pixels.
using RaycastTileFunction = void (*)(const VolumeView& volume, const RaycastView& view,
                                     const RaycastTile& tile);

}  // namespace kintsugi::mapper
