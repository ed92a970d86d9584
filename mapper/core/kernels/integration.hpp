#pragma once
// Fuses one frame into one block of voxels: the innermost loop of Integrator.

#include <cstdint>

#include "mapper/core/kernels/depth_variance.hpp"
#include "mapper/core/kernels/pinhole_camera.hpp"

namespace kintsugi::mapper {

/// The truncation distance of a measurement of depth d, as a share of the largest:
/// sigmas_per_m sigma(d) within [min_share, 1].
struct TruncationByDepth {
  float max_m = 0.0F;  ///< stored distances are fractions of this
  float inverse_max = 0.0F;
  float min_share = 1.0F;
  float sigmas_per_m = 0.0F;
  DepthVariance variance;
};

/// What is the same for all blocks of a frame. Images have no padding between rows.
struct IntegrationFrame {
  const float* depth_m = nullptr;             ///< height x width; NaN is invalid
  const std::uint32_t* color_rgbx = nullptr;  ///< red in the lowest byte; null: no colour
  PinholeCamera camera;
  float step_C[3][3] = {};  ///< [axis of W]: metres in C from one voxel to the next
  float min_depth_m = 0.0F;
  float max_depth_m = 0.0F;
  TruncationByDepth truncation = {};
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
