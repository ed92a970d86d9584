#include "mapper/core/extraction/slice_blocks.hpp"

#include <algorithm>

namespace kintsugi::mapper {

SliceBlocks::SliceBlocks(const DetachedBlocks& blocks) {
  blocks_.reserve(blocks.coords.size() + blocks.apron_coords.size());
  for (std::size_t i = 0; i < blocks.coords.size(); ++i) {
    blocks_.push_back({blocks.coords[i], blocks.voxels[i], blocks.colors[i], true});
  }
  for (std::size_t i = 0; i < blocks.apron_coords.size(); ++i) {
    blocks_.push_back(
        {blocks.apron_coords[i], blocks.apron_voxels[i], blocks.apron_colors[i], false});
  }
  std::inplace_merge(
      blocks_.begin(), blocks_.begin() + static_cast<std::ptrdiff_t>(blocks.coords.size()),
      blocks_.end(), [](const Block& a, const Block& b) { return a.coord < b.coord; });
}

BlockNeighbors NeighborWalk::around(std::size_t index) {
  BlockNeighbors neighbors;
  neighbors.fill(kNoNeighbor);
  const BlockCoord& center = blocks_[index].coord;
  for (int row = 0; row < 9; ++row) {
    const BlockCoord first =
        make_block_coord(center.x - 1, center.y + row % 3 - 1, center.z + row / 3 - 1);
    std::size_t& cursor = cursors_[row];
    while (cursor < blocks_.size() && blocks_[cursor].coord < first) ++cursor;
    for (std::size_t i = cursor; i < blocks_.size(); ++i) {
      const BlockCoord& coord = blocks_[i].coord;
      const int offset = coord.x - first.x;
      if (coord.z != first.z || coord.y != first.y || offset > 2) break;
      neighbors[row * 3 + offset] = static_cast<int>(i);
    }
  }
  return neighbors;
}

}  // namespace kintsugi::mapper
