#pragma once
// The constants of tsdf_block.hpp that kernels need. They are repeated here because kernels may not
// use code that other sources compile too (see simd/pack_portable.hpp); tsdf_volume.cpp checks that
// both agree.

namespace kintsugi::mapper {

struct BlockLayout {
  static constexpr int kSideBits = 3;
  static constexpr int kSide = 1 << kSideBits;      ///< kBlockSide
  static constexpr int kVoxelBits = 3 * kSideBits;  ///< kBlockVoxels is 1 << kVoxelBits
  static constexpr float kDistanceScale = 32767.0F;
};

}  // namespace kintsugi::mapper
