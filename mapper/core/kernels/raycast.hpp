#pragma once
// Casts the rays of one tile of pixels into the volume: the innermost loop of Raycaster.

#include "mapper/core/kernels/pinhole_camera.hpp"
#include "mapper/core/kernels/volume_access.hpp"

namespace kintsugi::mapper {

/// What is the same for all tiles of an image.
struct RaycastArguments {
  PinholeCamera camera;
  float origin_vox[3] = {};    ///< the camera's centre in cube coordinates
  float vox_per_m[3][3] = {};  ///< [axis of the cube][axis of C]: R_WC / resolution_m

  const float* guide_m = nullptr;  ///< expected depths at any image size, NaN: none; or null
  int guide_columns = 0;
  int guide_rows = 0;
  float guide_margin_m = 0.0F;  ///< a ray with a guide starts this far before it

  float* depth_m = nullptr;  ///< output: height x width, without padding; NaN: no surface
};

/// Pixels [u, u + side) x [v, v + side), clipped to the image, and the depths between which their
/// rays can meet a block; near_m > far_m where they meet none.
struct RaycastTile {
  static constexpr int kSide_px = 8;
  int u = 0;
  int v = 0;
  float near_m = 0.0F;
  float far_m = 0.0F;
};

/// Writes the depths of the tile's pixels.
using RaycastTileFunction = void (*)(const VolumeAccess& volume, const RaycastArguments& arguments,
                                     const RaycastTile& tile);

}  // namespace kintsugi::mapper
