#pragma once

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/kernels/kernels.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Allocates the blocks of the cube that the rays of pixels with a depth within [min_depth_m,
/// max_depth_m] (metres; NaN is not) meet within the truncation distance of that depth. Slots are
/// given in the order of the blocks' coordinates, whatever the number of threads
/// and the kernels. `depth_m` is of the intrinsics' size and without padding between rows.
void allocate_seen_blocks(const cv::Mat_<float>& depth_m, const Intrinsics& intrinsics,
                          const Pose& X_WC, float min_depth_m, float max_depth_m,
                          const Kernels& kernels, TsdfVolume& volume);

}  // namespace kintsugi::mapper
