#include "mapper/core/padded_block.hpp"

#include <algorithm>

namespace kintsugi::mapper {
namespace {

/// The part of a neighbour, at `offset` blocks along an axis, that lies in the padding.
struct Overlap {
  explicit Overlap(int offset)
      : first(std::max(-PaddedBlock::kPad, offset * kBlockSide)),
        end(std::min(kBlockSide + PaddedBlock::kPad, (offset + 1) * kBlockSide)) {}
  int first;
  int end;
};

}  // namespace

PaddedBlock::PaddedBlock(const DetachedBlocks& blocks, const BlockCoord& coord) {
  for (int neighbor = 0; neighbor < 27; ++neighbor) {
    const int dx = neighbor % 3 - 1;
    const int dy = neighbor / 3 % 3 - 1;
    const int dz = neighbor / 9 - 1;
    const VoxelBlock* block =
        blocks.find(make_block_coord(coord.x + dx, coord.y + dy, coord.z + dz));
    if (block == nullptr) continue;
    const Overlap xs(dx);
    const Overlap ys(dy);
    const Overlap zs(dz);
    for (int z = zs.first; z < zs.end; ++z) {
      for (int y = ys.first; y < ys.end; ++y) {
        const Voxel* row = &block->voxels[voxel_index(xs.first - dx * kBlockSide,
                                                      y - dy * kBlockSide, z - dz * kBlockSide)];
        std::copy_n(row, xs.end - xs.first, &voxels_[index(xs.first, y, z)]);
      }
    }
  }
}

}  // namespace kintsugi::mapper
