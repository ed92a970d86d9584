#pragma once

#include <opencv2/core.hpp>

#include "mapper/core/camera_view.hpp"
#include "mapper/core/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// Allocates the blocks of the cube that the rays of pixels with a depth within [min_depth_m,
/// max_depth_m] (metres; NaN is not) meet within the truncation distance of that depth. Slots are
/// given in the order of the blocks' coordinates, whatever the number of threads.
void allocate_seen_blocks(const cv::Mat_<float>& depth_m, const CameraView& view, float min_depth_m,
                          float max_depth_m, TsdfVolume& volume);

}  // namespace kintsugi::mapper
