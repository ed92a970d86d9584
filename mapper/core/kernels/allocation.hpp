#pragma once
// Finds the blocks along the rays of a depth image that the volume does not have yet.

#include <cstdint>

#include "mapper/core/kernels/pinhole_camera.hpp"
#include "mapper/core/kernels/volume_access.hpp"

namespace kintsugi::mapper {

/// A depth image, and how its rays are sampled: `half_steps` points of distance `step_m` before and
/// behind each measured depth.
struct AllocationArguments {
  const float* depth_m = nullptr;  ///< height x width, without padding
  PinholeCamera camera;
  int stride_px = 1;  ///< every stride_px-th pixel of a row is used
  float min_depth_m = 0.0F;
  float max_depth_m = 0.0F;
  float origin_blocks[3] = {};    ///< the camera's centre in cube coordinates
  float blocks_per_m[3][3] = {};  ///< [axis of the cube][axis of C]
  float step_m = 0.0F;            ///< along C's z
  int half_steps = 0;
};

/// Writes the missing blocks of the cube that row `v` needs, in cube coordinates packed as
/// x | y << kSideBits | z << 2 kSideBits; a block may be written more than once. Returns how many:
/// at most one for each point of each pixel that is used.
using FindMissingBlocks = int (*)(const VolumeAccess& volume, const AllocationArguments& arguments,
                                  int v, std::uint32_t* blocks);

}  // namespace kintsugi::mapper
