#pragma once

#include <vector>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/kernels/raycast.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {

/// The tiles of an image, row by row, with the depths between which their rays can meet a block of
/// the volume, from the bounding spheres of the visible blocks.
std::vector<RaycastTile> find_ray_tiles(const TsdfVolume& volume, const PinholeCamera& camera,
                                        const Pose& X_WC, float min_depth_m, float max_depth_m);

}  // namespace kintsugi::mapper
