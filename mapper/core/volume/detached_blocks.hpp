#pragma once

#include <memory>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

/// Blocks that left the volume together, with all that is needed to extract their surface
/// without the volume, so that another thread can do it.
struct DetachedBlocks {
  SliceKind kind = SliceKind::kFinal;
  float resolution_m = 0.0F;
  float truncation_m = 0.0F;  ///< stored distances are fractions of this

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

  /// The blocks that left, now or before, and may be in the apron of a later slice; ascending.
  std::vector<BlockCoord> bordering_coords;

  /// Keeps the pointed-to blocks alive; they do not change.
  std::shared_ptr<const void> storage;

  /// The voxels of a block, own or of the apron; null where there is none.
  const VoxelBlock* find(const BlockCoord& coord) const;
};

}  // namespace kintsugi::mapper
