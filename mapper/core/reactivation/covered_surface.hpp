#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/volume/detached_blocks.hpp"
#include "mapper/core/volume/same_surface_rule.hpp"
#include "mapper/core/volume/stored_block.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Blocks of another map O.
struct Cover {
  Pose X_OU = Pose::Identity();
  Eigen::Vector3d center_U = Eigen::Vector3d::Zero();
  double radius_m = 0.0;  ///< of a ball around all of them
  /// Ascending. What is seen from several keyframes has a cover for each, with the same blocks.
  std::shared_ptr<const std::vector<StoredBlock>> blocks;
  /// It was seen in U. Then the normals may have twice the angle, because where a surface ends they
  /// are noise; but not that of a wall and a floor.
  bool is_in_place = false;
};

/// Blocks of one frame U, and what may cover them.
struct BlocksUnderCovers {
  std::vector<BlockCoord> coords;
  std::vector<Cover> covers;
};

/// Clears the voxels of these blocks of the volume whose surface a cover has, too, and discards
/// blocks that have none left.
void clear_covered(TsdfVolume& volume, const std::vector<BlocksUnderCovers>& groups,
                   const SameSurface& same);

/// The same of blocks that have left a volume: what is left of them.
DetachedBlocks without_covered(DetachedBlocks blocks, const TsdfVolume::Config& volume,
                               const std::vector<BlocksUnderCovers>& groups,
                               const SameSurface& same);

}  // namespace kintsugi::mapper
