#pragma once

#include <Eigen/Core>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/kernels/pinhole_camera.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

struct VisibleBlock {
  BlockSlot slot = kNoBlock;
  Eigen::Vector3f center_C = Eigen::Vector3f::Zero();  ///< metres
};

/// Radius of a block's bounding sphere, metres.
float block_radius_m(const TsdfVolume& volume);

/// The blocks whose bounding sphere reaches into the camera's view frustum between depth 0 and
/// `max_depth_m`, in the order of their slots.
std::vector<VisibleBlock> find_visible_blocks(const TsdfVolume& volume, const PinholeCamera& camera,
                                              const Pose& X_WC, float max_depth_m);

}  // namespace kintsugi::mapper
