#pragma once
// What the kernels take, from what the rest of the core has.

#include "lcmtypes/geometry.hpp"
#include "mapper/core/frame/surface_map.hpp"
#include "mapper/core/kernels/surface_planes.hpp"
#include "mapper/core/kernels/volume_view.hpp"

namespace kintsugi::mapper {

class TsdfVolume;

PinholeCamera pinhole_camera(const Intrinsics& intrinsics);

/// Views of the surface's planes, which must stay where they are and have no padding.
SurfacePlanes planes_of(const SurfaceMap& surface);
MutableSurfacePlanes planes_of(SurfaceMap& surface);

/// Valid until the volume changes.
VolumeView view_of(const TsdfVolume& volume);

RigidMotion rigid_motion(const Pose& X_BA);

}  // namespace kintsugi::mapper
