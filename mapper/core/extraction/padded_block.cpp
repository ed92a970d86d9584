#include "mapper/core/extraction/padded_block.hpp"

#include <algorithm>

namespace kintsugi::mapper {

PaddedBlock::PaddedBlock(const SliceBlocks& blocks, const BlockNeighbors& neighbors) {
  static constexpr VoxelBlock kUnobserved{};
  const auto voxels_of = [&](int dx, int dy, int dz) {
    const int neighbor = neighbors[neighbor_index(dx, dy, dz)];
    return (neighbor == kNoNeighbor ? kUnobserved : *blocks[neighbor].voxels).voxels.data();
  };
  const auto offset_of = [](int voxel) { return voxel < 0 ? -1 : (voxel < kBlockSide ? 0 : 1); };
  for (int z = -kPad; z < kBlockSide + kPad; ++z) {
    const int dz = offset_of(z);
    for (int y = -kPad; y < kBlockSide + kPad; ++y) {
      const int dy = offset_of(y);
      const int row = voxel_index(0, y - dy * kBlockSide, z - dz * kBlockSide);
      Voxel* to = &voxels_[index(-kPad, y, z)];
      to = std::copy_n(voxels_of(-1, dy, dz) + row + kBlockSide - kPad, kPad, to);
      to = std::copy_n(voxels_of(0, dy, dz) + row, kBlockSide, to);
      std::copy_n(voxels_of(1, dy, dz) + row, kPad, to);
    }
  }
}

}  // namespace kintsugi::mapper
