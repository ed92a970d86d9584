#pragma once
// IntegrateBlock over any pack: two rows of eight voxels at a time.

#include "mapper/core/kernels/block_layout.hpp"
#include "mapper/core/kernels/integration.hpp"
#include "mapper/core/simd/depth_sigma.hpp"

namespace kintsugi::mapper {

template <typename Pack>
class BlockIntegration {
 public:
  explicit BlockIntegration(const IntegrationFrame& frame)
      : frame_(frame),
        width_(static_cast<float>(frame.camera.width)),
        height_(static_cast<float>(frame.camera.height)),
        cx_plus_half_(frame.camera.cx + 0.5F),
        cy_plus_half_(frame.camera.cy + 0.5F) {
    const Float x = to_float(Int::iota() & Int(kSide - 1));
    const Float y = to_float(shift_right<BlockLayout::kSideBits>(Int::iota()));
    for (int axis = 0; axis < 3; ++axis) {
      lane_C_[axis] = x * Float(frame.step_C[0][axis]) + y * Float(frame.step_C[1][axis]);
    }
  }

  void integrate(const IntegrationBlock& block) const {
    std::uint32_t* voxels = block.voxels;
    std::uint32_t* colors = block.colors;
    for (int z = 0; z < kSide; ++z) {
      for (int y = 0; y < kSide; y += 2) {
        Float point_C[3];
        for (int axis = 0; axis < 3; ++axis) {
          const float first =
              block.origin_C[axis] + (static_cast<float>(z) * frame_.step_C[2][axis] +
                                      static_cast<float>(y) * frame_.step_C[1][axis]);
          point_C[axis] = Float(first) + lane_C_[axis];
        }
        fuse_two_rows(point_C, voxels, colors);
        voxels += Pack::kNumLanes;
        colors += Pack::kNumLanes;
      }
    }
  }

 private:
  using Float = typename Pack::Float;
  using Int = typename Pack::Int;
  using Mask = typename Pack::Mask;

  static constexpr int kSide = BlockLayout::kSide;
  static_assert(Pack::kNumLanes == 2 * kSide);

  void fuse_two_rows(const Float point_C[3], std::uint32_t* voxels, std::uint32_t* colors) const {
    const Float& z = point_C[2];
    const Float inverse_z = Float(1.0F) / z;
    const Float u = point_C[0] * inverse_z * Float(frame_.camera.fx) + cx_plus_half_;
    const Float v = point_C[1] * inverse_z * Float(frame_.camera.fy) + cy_plus_half_;
    const Float zero(0.0F);
    const Mask in_view = (z > zero) & ((u >= zero) & (u < width_)) & ((v >= zero) & (v < height_));
    if (none(in_view)) return;

    const Int pixel = to_int(v) * Int(frame_.camera.width) + to_int(u);
    const Float depth = gather(frame_.depth_m, pixel, in_view);
    const Float sdf_m = depth - z;
    const Float share = truncation_share(depth);
    const Float truncation_m = share * Float(frame_.truncation.max_m);
    const Mask is_measured = in_view & (depth >= Float(frame_.min_depth_m)) &
                             (depth <= Float(frame_.max_depth_m)) & (sdf_m >= zero - truncation_m);
    if (none(is_measured)) return;
    fuse_distances(sdf_m, share, voxels).store(voxels, is_measured);

    if (frame_.color_rgbx == nullptr) return;
    const Mask is_near = is_measured & (sdf_m < truncation_m);
    if (none(is_near)) return;
    fuse_colors(gather(frame_.color_rgbx, pixel, is_near), colors).store(colors, is_near);
  }

  Float truncation_share(const Float& depth) const {
    const TruncationByDepth& in = frame_.truncation;
    const Float share = Float(in.sigmas_per_m) * depth_sigma_m(in.variance, depth);
    return min(max(share, Float(in.min_share)), Float(1.0F));
  }

  /// The running means of the voxels' distances with one more measurement. A mean that is farther
  /// behind a surface than this measurement could have it is of another surface, which a camera saw
  /// from the other side of a thin wall, from afar: it begins anew.
  Int fuse_distances(const Float& sdf_m, const Float& share, const std::uint32_t* voxels) const {
    const Int voxel = Int::load(voxels);
    const Float mean = to_float(shift_right_signed<16>(shift_left<16>(voxel)));
    const Float lowest = Float(0.0F) - share * Float(BlockLayout::kDistanceScale);
    const Float weight = select(mean < lowest, Float(0.0F), to_float(shift_right<16>(voxel)));
    const Float raised = weight + Float(1.0F);
    const Float measured = min(sdf_m * Float(frame_.truncation.inverse_max), share) *
                           Float(BlockLayout::kDistanceScale);
    const Float fused = (mean * weight + measured) * (Float(1.0F) / raised);
    const Float half = select(fused < Float(0.0F), Float(-0.5F), Float(0.5F));
    const Int rounded = to_int(fused + half);
    const Int capped = to_int(min(raised, Float(frame_.max_weight)));
    return (rounded & Int(0xFFFF)) | shift_left<16>(capped);
  }

  /// The running means of the voxels' colours; each channel is rounded to the nearest byte.
  Int fuse_colors(const Int& pixel, const std::uint32_t* colors) const {
    const Int color = Int::load(colors);
    const Float weight = to_float(shift_right<24>(color));
    const Float raised = weight + Float(1.0F);
    const Float inverse_raised = Float(1.0F) / raised;
    const auto fuse_channel = [&](const Int& mean, const Int& measured) {
      const Int byte(0xFF);
      const Float sum = to_float(mean & byte) * weight + to_float(measured & byte);
      return to_int(sum * inverse_raised + Float(0.5F));
    };
    const Int red = fuse_channel(color, pixel);
    const Int green = fuse_channel(shift_right<8>(color), shift_right<8>(pixel));
    const Int blue = fuse_channel(shift_right<16>(color), shift_right<16>(pixel));
    const Int capped = to_int(min(raised, Float(frame_.max_color_weight)));
    return red | shift_left<8>(green) | shift_left<16>(blue) | shift_left<24>(capped);
  }

  const IntegrationFrame& frame_;
  Float width_;
  Float height_;
  Float cx_plus_half_;  ///< so that rounding to the nearest pixel becomes truncation
  Float cy_plus_half_;
  Float lane_C_[3];  ///< metres in C from the first voxel of two rows to each
};

template <typename Pack>
void integrate_block(const IntegrationFrame& frame, const IntegrationBlock& block) {
  BlockIntegration<Pack>(frame).integrate(block);
}

}  // namespace kintsugi::mapper
