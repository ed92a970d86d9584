#pragma once
// The innermost loop of fusion: one frame into one block of voxels.
//
// There is one version for each instruction set, each in a source file compiled for it. Those files
// include nothing but this header and the compiler's intrinsics: an inline function from elsewhere,
// compiled there with wider instructions, could be the copy the linker keeps for everyone. All
// versions do the same single-precision operations in the same order, without fused
// multiply-adds, and so write the same bytes.

#include <cstdint>

namespace kintsugi::mapper {

/// A frame as the kernel wants it; rows without padding.
struct KernelFrame {
  const float* depth_m = nullptr;             ///< height x width; NaN is invalid
  const std::uint32_t* color_rgbx = nullptr;  ///< red in the lowest byte; null: no colour
  int width = 0;
  int height = 0;
  float fx = 0.0F;
  float fy = 0.0F;
  float cx_plus_half = 0.0F;  ///< cx + 1/2: rounding to the nearest pixel becomes truncation
  float cy_plus_half = 0.0F;
  float step_C[3][3] = {};  ///< [axis of W]: metres in C from one voxel to the next
  float min_depth_m = 0.0F;
  float max_depth_m = 0.0F;
  float truncation_m = 0.0F;
  float inverse_truncation = 0.0F;  ///< 1 / truncation_m
  float max_weight = 0.0F;
  float max_color_weight = 0.0F;
};

/// One block; see tsdf_block.hpp for the layout of the words.
struct KernelBlock {
  std::uint32_t* voxels = nullptr;  ///< 512, aligned to 64 bytes
  std::uint32_t* colors = nullptr;  ///< 512, aligned to 64 bytes
  float origin_C[3] = {};           ///< centre of voxel (0, 0, 0), metres in C
};

using IntegrationKernel = void (*)(const KernelFrame& frame, const KernelBlock& block);

void integrate_block_portable(const KernelFrame& frame, const KernelBlock& block);
void integrate_block_avx2(const KernelFrame& frame, const KernelBlock& block);

}  // namespace kintsugi::mapper
