#pragma once
// The kernel of block_sides.hpp over any pack: two rows at a time.

#include <cstddef>

#include "mapper/core/kernels/block_sides.hpp"

namespace kintsugi::mapper {

template <typename Pack>
void find_block_sides(const std::uint32_t* voxels, int num_rows, int weight_threshold,
                      RowSides* sides) {
  using Int = typename Pack::Int;
  constexpr int kSide = BlockLayout::kSide;
  static_assert(Pack::kNumLanes == 2 * kSide);
  for (int row = 0; row < num_rows; row += 2) {
    const Int voxel = Int::load(voxels + std::ptrdiff_t{row} * kSide);
    const auto weight = shift_right<16>(voxel);
    const std::uint32_t observed = (weight > Int(weight_threshold)).bits();
    const std::uint32_t behind = ((voxel & Int(0x8000)) != Int(0)).bits();
    for (int k = 0; k < 2; ++k) {
      sides[row + k].observed = static_cast<std::uint8_t>(observed >> (k * kSide));
      sides[row + k].behind = static_cast<std::uint8_t>(behind >> (k * kSide));
    }
  }
}

}  // namespace kintsugi::mapper
