#pragma once
// Fusion of a frame into a block, one voxel at a time: the operations of the kernels in their
// order, written without lanes.

#include <cmath>
#include <cstdint>

#include "mapper/core/kernels/integration.hpp"
#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper::testing {

inline float truncation_share(float depth_m, const TruncationByDepth& truncation) {
  const float squared = depth_m * depth_m;
  const float* c = truncation.variance.c;
  const float share = truncation.sigmas_per_m * std::sqrt(c[0] + squared * (c[1] + squared * c[2]));
  const float raised = share > truncation.min_share ? share : truncation.min_share;
  return raised < 1.0F ? raised : 1.0F;
}

inline Voxel fuse_distance(Voxel voxel, float sdf_m, float share, const IntegrationFrame& frame) {
  const auto mean = static_cast<float>(voxel_distance_raw(voxel));
  const bool is_of_other_surface = mean < 0.0F - share * kDistanceScale;
  const auto weight = is_of_other_surface ? 0.0F : static_cast<float>(voxel_weight(voxel));
  const float fraction = sdf_m * frame.truncation.inverse_max;
  const float measured = (fraction < share ? fraction : share) * kDistanceScale;
  const float raised = weight + 1.0F;
  const float fused = (mean * weight + measured) * (1.0F / raised);
  const auto rounded = static_cast<std::int32_t>(fused + (fused < 0.0F ? -0.5F : 0.5F));
  const float capped = raised < frame.max_weight ? raised : frame.max_weight;
  return (static_cast<std::uint32_t>(rounded) & 0xFFFFU) |
         (static_cast<std::uint32_t>(capped) << 16);
}

inline VoxelColor fuse_color(VoxelColor color, std::uint32_t pixel, const IntegrationFrame& frame) {
  const auto weight = static_cast<float>(color >> 24);
  const float raised = weight + 1.0F;
  const float inverse_raised = 1.0F / raised;
  const float capped = raised < frame.max_color_weight ? raised : frame.max_color_weight;
  VoxelColor result = static_cast<std::uint32_t>(capped) << 24;
  for (int shift = 0; shift < 24; shift += 8) {
    const auto mean = static_cast<float>((color >> shift) & 0xFFU);
    const auto measured = static_cast<float>((pixel >> shift) & 0xFFU);
    const float fused = (mean * weight + measured) * inverse_raised + 0.5F;
    result |= static_cast<std::uint32_t>(fused) << shift;
  }
  return result;
}

inline void fuse_voxel(const IntegrationFrame& frame, const float point_C[3], Voxel& voxel,
                       VoxelColor& color) {
  const PinholeCamera& camera = frame.camera;
  const float z = point_C[2];
  if (!(z > 0.0F)) return;
  const float inverse_z = 1.0F / z;
  const float u = point_C[0] * inverse_z * camera.fx + (camera.cx + 0.5F);
  const float v = point_C[1] * inverse_z * camera.fy + (camera.cy + 0.5F);
  if (!(u >= 0.0F && u < static_cast<float>(camera.width))) return;
  if (!(v >= 0.0F && v < static_cast<float>(camera.height))) return;
  const int pixel = static_cast<int>(v) * camera.width + static_cast<int>(u);
  const float depth = frame.depth_m[pixel];
  if (!(depth >= frame.min_depth_m && depth <= frame.max_depth_m)) return;
  const float sdf_m = depth - z;
  const float share = truncation_share(depth, frame.truncation);
  const float truncation_m = share * frame.truncation.max_m;
  if (!(sdf_m >= -truncation_m)) return;
  voxel = fuse_distance(voxel, sdf_m, share, frame);
  if (frame.color_rgbx == nullptr || !(sdf_m < truncation_m)) return;
  color = fuse_color(color, frame.color_rgbx[pixel], frame);
}

inline void integrate_slowly(const IntegrationFrame& frame, const IntegrationBlock& block) {
  for (int i = 0; i < kBlockVoxels; ++i) {
    const int x = i % kBlockSide;
    const int y = i / kBlockSide % kBlockSide;
    const int z = i / kBlockSide / kBlockSide;
    float point_C[3];
    for (int axis = 0; axis < 3; ++axis) {
      // Kernels process two rows at a time.
      const float first =
          block.origin_C[axis] + (static_cast<float>(z) * frame.step_C[2][axis] +
                                  static_cast<float>(y - y % 2) * frame.step_C[1][axis]);
      point_C[axis] = first + (static_cast<float>(x) * frame.step_C[0][axis] +
                               static_cast<float>(y % 2) * frame.step_C[1][axis]);
    }
    fuse_voxel(frame, point_C, block.voxels[i], block.colors[i]);
  }
}

}  // namespace kintsugi::mapper::testing
