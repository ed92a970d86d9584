#pragma once

#include <cmath>

#include <opencv2/core.hpp>

namespace kintsugi::viewer {

/// What a depth camera measures in each pixel of a picture that is taken from its place.
struct MeasuredDepth {
  cv::Mat1f depth_m;  ///< along the camera's z; 0: nothing is measured

  /// A surface at this depth is the one that is measured, not one behind or before it.
  ///
  /// They may differ by three voxels, because a map point is placed to within a voxel and the
  /// volume smooths edges over the width of the truncation, which is a few voxels; and by a
  /// hundredth of the distance, the error that depth cameras have at the far end of their range.
  bool agrees(int u, int v, float surface_m, float voxel_m) const {
    constexpr float kVoxels = 3.0F;
    constexpr float kShare = 0.01F;
    const float measured_m = depth_m(v, u);
    return measured_m > 0.0F &&
           std::abs(surface_m - measured_m) <= kVoxels * voxel_m + kShare * measured_m;
  }
};

}  // namespace kintsugi::viewer
