#pragma once

#include <algorithm>
#include <cmath>
#include <compare>

#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

/// A large patch is sent again for a small part that is new; many small ones are many messages.
inline constexpr double kUsualPatchSide_m = 0.25;

/// Coordinates of a tile, a cube of whole blocks, in tiles from W's origin. Ordered by z, then y,
/// then x.
struct TileCoord {
  int z = 0;
  int y = 0;
  int x = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 sees a pointer in the defaulted body
  auto operator<=>(const TileCoord&) const = default;
};

/// Divides space into tiles.
class TileGrid {
 public:
  /// Tiles have as many whole blocks along each axis as come nearest to `side_m`; at least one.
  TileGrid(double side_m, double resolution_m)
      : side_blocks_(
            std::max(1, static_cast<int>(std::lround(side_m / (kBlockSide * resolution_m))))) {}

  int side_blocks() const { return side_blocks_; }

  TileCoord tile_of(const BlockCoord& block) const {
    return {.z = divided(block.z), .y = divided(block.y), .x = divided(block.x)};
  }

  /// Calls visit(BlockCoord) for the place of each block of the tile, ascending.
  template <typename Visit>
  void for_each_block(const TileCoord& tile, Visit visit) const {
    const int side = side_blocks_;
    for (int z = tile.z * side; z < (tile.z + 1) * side; ++z) {
      for (int y = tile.y * side; y < (tile.y + 1) * side; ++y) {
        for (int x = tile.x * side; x < (tile.x + 1) * side; ++x) visit(make_block_coord(x, y, z));
      }
    }
  }

 private:
  int divided(int block) const {  // rounded down, also below zero
    return block >= 0 ? block / side_blocks_ : -((side_blocks_ - 1 - block) / side_blocks_);
  }

  int side_blocks_;
};

}  // namespace kintsugi::mapper
