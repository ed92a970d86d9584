#pragma once
// Images and poses in the form that kernels take.

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/kernels/depth_variance.hpp"
#include "mapper/core/kernels/surface.hpp"
#include "mapper/core/kernels/surface_planes.hpp"

namespace kintsugi::mapper {

/// Pointers into the planes of a surface, which have no padding between rows.
SurfacePlanes planes_of(const SurfaceMap& surface);
MutableSurfacePlanes planes_of(SurfaceMap& surface);

RigidMotion rigid_motion(const Pose& X_BA);

DepthVariance depth_variance(const DepthNoise& noise);

/// Which neighbouring depths of a camera belong to the same surface.
DepthTolerance depth_tolerance(const DepthNoise& local_noise, const Intrinsics& intrinsics);

}  // namespace kintsugi::mapper
