#pragma once
// Fuses one frame into one block of voxels: the innermost loop of Integrator.

#include <cstdint>

#include "mapper/core/kernels/pinhole_camera.hpp"

namespace kintsugi::mapper {

/// What is the same for all blocks of a frame. Images have no padding between rows.
struct IntegrationFrame {
  const float* depth_m = nullptr;             ///< height x width; NaN is invalid
  const std::uint32_t* color_rgbx = nullptr;  ///< red in the lowest byte; null: no colour
  PinholeCamera camera;
  float step_C[3][3] = {};  ///< [axis of W]: metres in C from one voxel to the next
  float min_depth_m = 0.0F;
  float max_depth_m = 0.0F;
  float truncation_m = 0.0F;
  float inverse_truncation = 0.0F;  ///< 1 / truncation_m
  float max_weight = 0.0F;
  float max_color_weight = 0.0F;
};

/// One block; see tsdf_block.hpp for the layout of the words.
struct IntegrationBlock {
  std::uint32_t* voxels = nullptr;  ///< 512
  std::uint32_t* colors = nullptr;  ///< 512
  float origin_C[3] = {};           ///< centre of voxel (0, 0, 0), metres in C
};

using IntegrateBlock = void (*)(const IntegrationFrame& frame, const IntegrationBlock& block);

}  // namespace kintsugi::mapper
