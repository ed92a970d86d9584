#pragma once
// tsdf_block.hpp says what these mean; the kernels may not include it.

namespace kintsugi::mapper {

struct BlockLayout {
  static constexpr int kSideBits = 3;
  static constexpr int kSide = 1 << kSideBits;      ///< kBlockSide
  static constexpr int kVoxelBits = 3 * kSideBits;  ///< kBlockVoxels is 1 << kVoxelBits
  static constexpr float kDistanceScale = 32767.0F;
};

}  // namespace kintsugi::mapper
