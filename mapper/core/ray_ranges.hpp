#pragma once

#include <vector>

#include "mapper/core/camera_view.hpp"
#include "mapper/core/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Between which depths a ray can meet a block of the volume: bounds for each tile of pixels, from
/// the bounding spheres of the blocks in view.
class RayRanges {
 public:
  struct Range {
    float near_m = 0.0F;  ///< along C's z; near_m > far_m: no block
    float far_m = 0.0F;
  };

  RayRanges(const TsdfVolume& volume, const CameraView& view, float min_depth_m, float max_depth_m);

  const Range& at(int u, int v) const {
    return tiles_[(v / kTileSide_px) * num_columns_ + u / kTileSide_px];
  }

 private:
  static constexpr int kTileSide_px = 8;

  int num_columns_ = 0;
  int num_rows_ = 0;
  std::vector<Range> tiles_;
};

}  // namespace kintsugi::mapper
