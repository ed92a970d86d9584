#pragma once

#include <cstddef>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

struct DetachedBlocks;

/// Points in W, in the order of blocks and voxels.
struct ExtractedSurface {
  struct Block {  ///< a block that has points
    BlockCoord coord;
    std::size_t first_point = 0;
    std::size_t num_points = 0;
  };
  std::vector<CloudPoint> points_W;
  std::vector<Block> blocks;  ///< ascending
};

/// Extracts the surface in a set of blocks as points with normals.
///
/// A crossing is where the distance is zero, interpolated between the centres of two neighbouring
/// voxels whose weights are both above the threshold; it belongs to the voxel in which it lies.
/// Where the distance jumps there is no crossing (see CrossingRule). The mean of the crossings of
/// one voxel is one point. So every surface voxel gives one point, in whichever order and in
/// however many slices the blocks are extracted.
class SurfaceExtractor {
 public:
  struct Config {
    int weight_threshold = 8;        ///< voxels with no more observations than this are ignored
    double max_step_vox = 4.0;       ///< largest change of the distance between neighbours: that of
                                     ///< a surface seen at 75 degrees from its normal
    double normal_radius_vox = 2.0;  ///< of the averaging of normals, at most 2

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  explicit SurfaceExtractor(const Config& config);

  /// Points in W of the detached blocks (not of the apron), in the order of blocks and voxels.
  /// Normals point into free space: the gradient of the distance by central differences, averaged
  /// once. Colour and weight are those of the point's voxel. Thread-safe, and uses no other thread.
  ExtractedSurface extract_blocks(const DetachedBlocks& detached) const;
  /// The points alone.
  std::vector<CloudPoint> extract(const DetachedBlocks& detached) const {
    return extract_blocks(detached).points_W;
  }

 private:
  Config config_;
};

}  // namespace kintsugi::mapper
