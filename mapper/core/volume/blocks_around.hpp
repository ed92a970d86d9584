#pragma once

#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

/// Calls visit(BlockCoord) for the block and the 26 around it, ascending.
template <typename Visit>
void for_each_around(const BlockCoord& coord, Visit visit) {
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        visit(make_block_coord(coord.x + dx, coord.y + dy, coord.z + dz));
      }
    }
  }
}

}  // namespace kintsugi::mapper
