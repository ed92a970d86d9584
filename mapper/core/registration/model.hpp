#pragma once

#include <Eigen/Geometry>
#include <limits>

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/surface_pyramid.hpp"

namespace kintsugi::mapper {

/// What a frame is registered with: the surface of the map as seen from a pose near the camera's.
/// V is the virtual camera at that pose.
struct Model {
  SurfacePyramid surface_V;
  Pose X_WV = Pose::Identity();
  double voxel_m = 0.0087890625;  ///< side of the map's voxels
  /// Where the map can have surface, metres: frame points outside count neither for nor against a
  /// pose.
  Eigen::AlignedBox3d region_W{Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity()),
                               Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())};
};

}  // namespace kintsugi::mapper
