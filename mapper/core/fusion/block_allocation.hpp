#pragma once

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Allocates the blocks of the volume that rays meet within its smallest truncation distance of
/// their measured depth, for depths within [min_depth_m, max_depth_m] (metres; invalid is NaN). New
/// blocks get slots in the order of their coordinates, whatever the number of threads and the
/// kernels. `depth_m` has the camera's size and no padding between rows.
void allocate_seen_blocks(const cv::Mat_<float>& depth_m, const PinholeCamera& camera,
                          const Pose& X_WC, float min_depth_m, float max_depth_m,
                          const Kernels& kernels, TsdfVolume& volume);

}  // namespace kintsugi::mapper
