#pragma once

#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Tells which blocks hold free space only: observed often enough, with each observed voxel at
/// least the smallest truncation distance before a surface. Noisy depth allocates many such blocks;
/// they say no more than that nothing is there, as blocks that do not exist do.
class FreeSpace {
 public:
  explicit FreeSpace(const TsdfVolume& volume);

  /// A block's turn to be looked at is one move of the volume in 16; never in a cube.
  bool is_due(const BlockCoord& coord) const;
  bool is_all_of(const VoxelBlock& block) const;

 private:
  bool is_kept_;
  std::uint32_t num_moves_;
  int least_distance_raw_;
};

}  // namespace kintsugi::mapper
