#pragma once

#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/tsdf_block.hpp"

namespace kintsugi::mapper {

/// Blocks that left the volume at one moment, with all that is needed to extract their surface
/// without the volume: the thread that tracks moves on, another one extracts.
struct DetachedBlocks {
  SliceKind kind = SliceKind::kFinal;
  float resolution_m = 0.0F;
  float truncation_m = 0.0F;

  /// Ascending; `voxels` and `colors` are in the same order.
  std::vector<BlockCoord> coords;
  std::vector<VoxelBlock> voxels;
  std::vector<ColorBlock> colors;

  /// Copies of the blocks that touch the above by a face, edge or corner: those still in the
  /// volume, and those that left it before. Ascending.
  std::vector<BlockCoord> apron_coords;
  std::vector<VoxelBlock> apron_voxels;

  /// The voxels of a block of either kind, or null where there is none.
  const VoxelBlock* find(const BlockCoord& coord) const;
};

}  // namespace kintsugi::mapper
