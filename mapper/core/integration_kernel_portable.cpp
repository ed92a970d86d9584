// Fusion of a frame into a block, for any processor; what the vector versions are tested against.

#include "mapper/core/integration_kernel.hpp"

namespace kintsugi::mapper {
namespace {

constexpr int kSide = 8;
constexpr float kScale = 32767.0F;  // kDistanceScale

std::uint32_t fuse_distance(std::uint32_t voxel, float sdf_m, const KernelFrame& frame) {
  const float mean = static_cast<float>(static_cast<std::int16_t>(voxel & 0xFFFFU));
  const float weight = static_cast<float>(voxel >> 16);
  const float fraction = sdf_m * frame.inverse_truncation;
  const float measured = (fraction < 1.0F ? fraction : 1.0F) * kScale;
  const float raised = weight + 1.0F;
  const float fused = (mean * weight + measured) * (1.0F / raised);
  const auto rounded = static_cast<std::int32_t>(fused + (fused < 0.0F ? -0.5F : 0.5F));
  const float capped = raised < frame.max_weight ? raised : frame.max_weight;
  return (static_cast<std::uint32_t>(rounded) & 0xFFFFU) |
         (static_cast<std::uint32_t>(static_cast<std::int32_t>(capped)) << 16);
}

std::uint32_t fuse_color(std::uint32_t color, std::uint32_t pixel, const KernelFrame& frame) {
  const float weight = static_cast<float>(color >> 24);
  const float raised = weight + 1.0F;
  const float inverse_raised = 1.0F / raised;
  const float capped = raised < frame.max_color_weight ? raised : frame.max_color_weight;
  std::uint32_t result = static_cast<std::uint32_t>(static_cast<std::int32_t>(capped)) << 24;
  for (int shift = 0; shift < 24; shift += 8) {
    const float mean = static_cast<float>((color >> shift) & 0xFFU);
    const float measured = static_cast<float>((pixel >> shift) & 0xFFU);
    const float fused = (mean * weight + measured) * inverse_raised + 0.5F;
    result |= static_cast<std::uint32_t>(static_cast<std::int32_t>(fused)) << shift;
  }
  return result;
}

void fuse_voxel(const KernelFrame& frame, float x, float y, float z, std::uint32_t* voxel,
                std::uint32_t* color) {
  if (!(z > 0.0F)) return;
  const float inverse_z = 1.0F / z;
  const float u = x * inverse_z * frame.fx + frame.cx_plus_half;
  const float v = y * inverse_z * frame.fy + frame.cy_plus_half;
  if (!(u >= 0.0F && u < static_cast<float>(frame.width))) return;
  if (!(v >= 0.0F && v < static_cast<float>(frame.height))) return;
  const int pixel = static_cast<int>(v) * frame.width + static_cast<int>(u);
  const float depth = frame.depth_m[pixel];
  if (!(depth >= frame.min_depth_m && depth <= frame.max_depth_m)) return;
  const float sdf_m = depth - z;
  if (!(sdf_m >= -frame.truncation_m)) return;
  *voxel = fuse_distance(*voxel, sdf_m, frame);
  if (frame.color_rgbx == nullptr || !(sdf_m < frame.truncation_m)) return;
  *color = fuse_color(*color, frame.color_rgbx[pixel], frame);
}

}  // namespace

void integrate_block_portable(const KernelFrame& frame, const KernelBlock& block) {
  std::uint32_t* voxels = block.voxels;
  std::uint32_t* colors = block.colors;
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      float row_C[3];
      for (int i = 0; i < 3; ++i) {
        row_C[i] = block.origin_C[i] + (static_cast<float>(z) * frame.step_C[2][i] +
                                        static_cast<float>(y) * frame.step_C[1][i]);
      }
      for (int lane = 0; lane < kSide; ++lane) {
        const auto steps = static_cast<float>(lane);
        fuse_voxel(frame, row_C[0] + steps * frame.step_C[0][0],
                   row_C[1] + steps * frame.step_C[0][1], row_C[2] + steps * frame.step_C[0][2],
                   voxels++, colors++);
      }
    }
  }
}

}  // namespace kintsugi::mapper
