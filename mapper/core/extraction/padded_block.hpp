#pragma once

#include <array>

#include "mapper/core/extraction/slice_blocks.hpp"

namespace kintsugi::mapper {

/// A block's voxels and those within kPad of it: all on which its crossings and gradients depend.
class PaddedBlock {
 public:
  static constexpr int kPad = 2;
  static constexpr int kSide = kBlockSide + 2 * kPad;
  static constexpr int kNumVoxels = kSide * kSide * kSide;

  /// Voxels of missing blocks read as never observed.
  PaddedBlock(const SliceBlocks& blocks, const BlockNeighbors& neighbors);

  /// Coordinates from the block's first voxel, each in [-kPad, kBlockSide + kPad).
  static constexpr int index(int x, int y, int z) {
    return ((z + kPad) * kSide + (y + kPad)) * kSide + (x + kPad);
  }
  /// Index step from a voxel to the next along x, y or z.
  static constexpr std::array<int, 3> kStride = {1, kSide, kSide* kSide};

  Voxel operator[](int index) const { return voxels_[index]; }

 private:
  std::array<Voxel, kNumVoxels> voxels_;  ///< the constructor sets them all
};

}  // namespace kintsugi::mapper
