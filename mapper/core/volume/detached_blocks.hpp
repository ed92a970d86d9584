#pragma once

#include <memory>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

/// A box of blocks: min .. min + side - 1 along each axis.
struct BlockCube {
  BlockCoord min;
  int side = 0;

  bool contains(const BlockCoord& coord) const {
    const auto length = static_cast<unsigned>(side);
    return static_cast<unsigned>(coord.x - min.x) < length &&
           static_cast<unsigned>(coord.y - min.y) < length &&
           static_cast<unsigned>(coord.z - min.z) < length;
  }
  /// Whether a block is in the cube or has a face, an edge or a corner in common with it.
  bool touches(const BlockCoord& coord) const {
    return side > 0 &&
           BlockCube{make_block_coord(min.x - 1, min.y - 1, min.z - 1), side + 2}.contains(coord);
  }
};

/// Blocks that left the volume at one moment, with all that is needed to extract their surface
/// without the volume: the thread that tracks moves on, another one extracts.
struct DetachedBlocks {
  SliceKind kind = SliceKind::kFinal;
  float resolution_m = 0.0F;
  float truncation_m = 0.0F;

  /// Ascending; `voxels` and `colors` are in the same order.
  std::vector<BlockCoord> coords;
  std::vector<const VoxelBlock*> voxels;
  std::vector<const ColorBlock*> colors;

  /// The blocks that touch the above by a face, edge or corner, ascending: those that stay in the
  /// volume, as they were at that moment, and those that left it before, as they were then.
  std::vector<BlockCoord> apron_coords;
  std::vector<const VoxelBlock*> apron_voxels;
  std::vector<const ColorBlock*> apron_colors;  ///< null: the block stays in the volume

  /// What the volume covers from then on.
  BlockCube remaining;

  /// Keeps what the pointers point to, which nobody changes meanwhile.
  std::shared_ptr<const void> storage;

  /// The voxels of a block of either kind, or null where there is none.
  const VoxelBlock* find(const BlockCoord& coord) const;
};

}  // namespace kintsugi::mapper
