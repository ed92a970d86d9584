#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mapper/core/volume/detached_blocks.hpp"

namespace kintsugi::mapper {

/// The blocks of a slice and of its apron in one ascending sequence.
class SliceBlocks {
 public:
  struct Block {
    BlockCoord coord;
    const VoxelBlock* voxels = nullptr;
    const ColorBlock* colors = nullptr;  ///< null: the block stays in the volume
    bool is_own = false;                 ///< of the slice, not of the apron
  };

  explicit SliceBlocks(const DetachedBlocks& blocks);

  std::size_t size() const { return blocks_.size(); }
  const Block& operator[](std::size_t index) const { return blocks_[index]; }

 private:
  std::vector<Block> blocks_;
};

/// Indices into SliceBlocks of a block and of the 26 around it; kNoNeighbor where there is none.
/// The block at offset (dx, dy, dz) is at neighbor_index(dx, dy, dz).
using BlockNeighbors = std::array<int, 27>;
inline constexpr int kNoNeighbor = -1;
inline constexpr int neighbor_index(int dx, int dy, int dz) {
  return (dz + 1) * 9 + (dy + 1) * 3 + dx + 1;
}

/// Finds the neighbours of blocks that are visited in ascending order, in constant time on average.
class NeighborWalk {
 public:
  explicit NeighborWalk(const SliceBlocks& blocks) : blocks_(blocks) {}

  /// `index` must not be smaller than in the call before.
  BlockNeighbors around(std::size_t index);

 private:
  const SliceBlocks& blocks_;
  std::array<std::size_t, 9> cursors_{};  ///< for each of the nine rows of neighbours
};

}  // namespace kintsugi::mapper
