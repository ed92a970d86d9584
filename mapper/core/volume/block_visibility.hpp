#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapper/core/frame/camera_view.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

struct VisibleBlock {
  BlockSlot slot = kNoBlock;
  Eigen::Vector3f center_C = Eigen::Vector3f::Zero();  ///< metres
};

/// Radius of the sphere around a block, metres.
float block_radius_m(const TsdfVolume& volume);

/// The volume's blocks whose bounding sphere reaches into the view, between depth 0 and
/// `max_depth_m`, in the order of their slots.
std::vector<VisibleBlock> find_visible_blocks(const TsdfVolume& volume, const CameraView& view,
                                              float max_depth_m);

}  // namespace kintsugi::mapper
