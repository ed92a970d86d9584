#pragma once

#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::mapper {

struct DetachedBlocks;

/// The surface in a set of blocks, as points with normals.
///
/// A crossing is where the distance, linear between the centres of two neighbouring voxels whose
/// weights are both above the threshold, is zero; it belongs to the voxel in which it lies. Where
/// the distance jumps there is none: that is an outline past which the camera saw, no surface. The
/// crossings of one voxel make one point, their mean. So every surface voxel gives one point, in
/// whichever order and in however many pieces the blocks are extracted.
class SurfaceExtractor {
 public:
  struct Config {
    int weight_threshold = 8;        ///< voxels with no more observations than this are ignored
    double max_step_vox = 4.0;       ///< between neighbours; a surface seen at 75 degrees has that
    double normal_radius_vox = 2.0;  ///< normals are averaged over the surface within this, <= 2

    /// @throws std::invalid_argument naming the field, its value and the bound.
    void validate() const;
  };

  explicit SurfaceExtractor(const Config& config);

  /// Points in W of the detached blocks (not of the apron), in the order of blocks and voxels.
  /// Normals point into free space: the gradient of the distance by central differences, averaged
  /// once. Colour and weight are those of the point's voxel. On the caller's thread alone, which
  /// may be any.
  std::vector<CloudPoint> extract(const DetachedBlocks& detached) const;

 private:
  Config config_;
};

}  // namespace kintsugi::mapper
