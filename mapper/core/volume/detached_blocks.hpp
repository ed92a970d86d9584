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
  /// Whether a block is in the cube or shares a face, an edge or a corner with it.
  bool touches(const BlockCoord& coord) const {
    return side > 0 &&
           BlockCube{make_block_coord(min.x - 1, min.y - 1, min.z - 1), side + 2}.contains(coord);
  }
};

/// Blocks that left the volume in one shift, with all that is needed to extract their surface
/// without the volume, so that another thread can do it.
struct DetachedBlocks {
  SliceKind kind = SliceKind::kFinal;
  float resolution_m = 0.0F;
  float truncation_m = 0.0F;

  /// Ascending; `voxels` and `colors` are in the same order.
  std::vector<BlockCoord> coords;
  std::vector<const VoxelBlock*> voxels;
  std::vector<const ColorBlock*> colors;

  /// The apron: the blocks that share a face, edge or corner with the above, ascending. Those that
  /// stay in the volume are copied as they are at the shift; those that left before are as they
  /// were when they left.
  std::vector<BlockCoord> apron_coords;
  std::vector<const VoxelBlock*> apron_voxels;
  std::vector<const ColorBlock*> apron_colors;  ///< null: the block stays in the volume

  /// The cube of the volume after the shift.
  BlockCube remaining;

  /// Keeps the pointed-to blocks alive; they do not change.
  std::shared_ptr<const void> storage;

  /// The voxels of a block, own or of the apron; null where there is none.
  const VoxelBlock* find(const BlockCoord& coord) const;
};

}  // namespace kintsugi::mapper
