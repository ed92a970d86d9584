#pragma once

#include <Eigen/Geometry>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/kernels/kernels.hpp"

namespace kintsugi::mapper {

/// The share of all pixels whose point lies in the region.
double covered_share(const SurfaceMap& frame_C, const Pose& X_WC,
                     const Eigen::AlignedBox3d& region_W, const Kernels& kernels = best_kernels());

}  // namespace kintsugi::mapper
