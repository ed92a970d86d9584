#pragma once
// Images and poses in the form that kernels take.

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/kernels/surface_planes.hpp"

namespace kintsugi::mapper {

/// Pointers into the planes of a surface, which have no padding between rows.
SurfacePlanes planes_of(const SurfaceMap& surface);
MutableSurfacePlanes planes_of(SurfaceMap& surface);

RigidMotion rigid_motion(const Pose& X_BA);

}  // namespace kintsugi::mapper
