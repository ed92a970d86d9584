#pragma once
// Which blocks a depth image needs and the volume does not have.

#include <cstdint>

#include "mapper/core/kernels/surface_planes.hpp"
#include "mapper/core/kernels/volume_view.hpp"

namespace kintsugi::mapper {

/// A depth image and the part of its rays along which blocks are needed: steps to either side of
/// each depth.
struct AllocationView {
  const float* depth_m = nullptr;  ///< height x width, without padding
  PinholeCamera camera;
  int stride_px = 1;  ///< one pixel of so many along a row is looked at
  float min_depth_m = 0.0F;
  float max_depth_m = 0.0F;
  float origin_blocks[3] = {};    ///< of the camera, cube coordinates
  float blocks_per_m[3][3] = {};  ///< [axis of the cube][axis of C]
  float step_m = 0.0F;            ///< along the camera's z
  int half_steps = 0;             ///< from each depth forwards, and backwards
};

/// Writes the blocks of the cube that row `v` needs and that do not exist, in cube coordinates x |
/// y << kSideBits | z << 2 kSideBits, some of them more than once. Returns how many: at most
/// one for each step of each pixel that is looked at.
using FindMissingBlocks = int (*)(const VolumeView& volume, const AllocationView& view, int v,
                                  std::uint32_t* blocks);

}  // namespace kintsugi::mapper
