#pragma once
// FindMissingBlocks over any pack: the rays of sixteen pixels at once.

#include "mapper/core/kernels/allocation.hpp"
#include "mapper/core/simd/volume_lanes.hpp"

namespace kintsugi::mapper {

template <typename Pack>
class MissingBlocks {
 public:
  MissingBlocks(const VolumeAccess& volume, const AllocationArguments& arguments,
                std::uint32_t* blocks)
      : volume_(volume), in_(arguments), blocks_(blocks) {}

  int find_in_row(int v) {
    const int step = in_.stride_px * Pack::kNumLanes;
    for (int u = 0; u < in_.camera.width; u += step) find_in_pixels(u, v);
    return count_;
  }

 private:
  using Float = typename Pack::Float;
  using Int = typename Pack::Int;
  using Mask = typename Pack::Mask;

  void find_in_pixels(int first_u, int v) {
    const PinholeCamera& camera = in_.camera;
    const Int u = Int(first_u) + Int::iota() * Int(in_.stride_px);
    const Float depth_m = gather(in_.depth_m, Int(v * camera.width) + u, u < Int(camera.width));
    // Lanes outside the image have depth zero, which is below min_depth_m.
    const Mask is_valid = (depth_m >= Float(in_.min_depth_m)) & (depth_m <= Float(in_.max_depth_m));
    if (none(is_valid)) return;
    const Float x = (to_float(u) - Float(camera.cx)) * Float(camera.inverse_fx);
    const float y = (static_cast<float>(v) - camera.cy) * camera.inverse_fy;
    const auto along_axis = [&](const float per_m[3]) {
      return Float(per_m[0]) * x + Float(per_m[1] * y + per_m[2]);
    };
    const Float direction[] = {along_axis(in_.blocks_per_m[0]), along_axis(in_.blocks_per_m[1]),
                               along_axis(in_.blocks_per_m[2])};
    for (int step = -in_.half_steps; step <= in_.half_steps; ++step) {
      const Float z_m = depth_m + Float(static_cast<float>(step) * in_.step_m);
      const auto block_at = [&](int axis) {
        return to_int(floor(Float(in_.origin_blocks[axis]) + direction[axis] * z_m));
      };
      const Int block[] = {block_at(0), block_at(1), block_at(2)};
      const Mask is_missing = volume_.is_missing(block[0], block[1], block[2], is_valid);
      if (any(is_missing)) append(block, is_missing);
    }
  }

  void append(const Int block[3], const Mask& mask) {
    constexpr int kBits = VolumeAccess::kSideBits;
    const Int packed = block[0] | shift_left<kBits>(block[1]) | shift_left<2 * kBits>(block[2]);
    std::uint32_t lanes[Pack::kNumLanes];
    packed.store(lanes);
    const std::uint32_t bits = mask.bits();
    for (int i = 0; i < Pack::kNumLanes; ++i) {
      const bool is_new = count_ == 0 || blocks_[count_ - 1] != lanes[i];
      if (((bits >> i) & 1U) != 0 && is_new) blocks_[count_++] = lanes[i];
    }
  }

  VolumeLanes<Pack> volume_;
  const AllocationArguments& in_;
  std::uint32_t* blocks_;
  int count_ = 0;
};

template <typename Pack>
int find_missing_blocks(const VolumeAccess& volume, const AllocationArguments& arguments, int v,
                        std::uint32_t* blocks) {
  return MissingBlocks<Pack>(volume, arguments, blocks).find_in_row(v);
}

}  // namespace kintsugi::mapper
