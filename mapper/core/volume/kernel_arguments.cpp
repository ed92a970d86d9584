#include "mapper/core/volume/kernel_arguments.hpp"

#include <cassert>

#include "mapper/core/kernels/block_layout.hpp"
#include "mapper/core/volume/tsdf_volume.hpp"

namespace kintsugi::mapper {
namespace {

static_assert(BlockLayout::kSide == kBlockSide);
static_assert(1 << BlockLayout::kVoxelBits == kBlockVoxels);
static_assert(BlockLayout::kDistanceScale == kDistanceScale);

template <typename Number, typename Surface>
Planes<Number> planes(Surface& surface) {
  assert(surface.depth_m.isContinuous() && surface.normal_x.isContinuous() &&
         surface.normal_y.isContinuous() && surface.normal_z.isContinuous());
  return {.depth_m = surface.depth_m[0],
          .normal_x = surface.normal_x[0],
          .normal_y = surface.normal_y[0],
          .normal_z = surface.normal_z[0],
          .camera = pinhole_camera(surface.intrinsics)};
}

}  // namespace

PinholeCamera pinhole_camera(const Intrinsics& intrinsics) {
  return {.width = intrinsics.width,
          .height = intrinsics.height,
          .fx = static_cast<float>(intrinsics.fx),
          .fy = static_cast<float>(intrinsics.fy),
          .cx = static_cast<float>(intrinsics.cx),
          .cy = static_cast<float>(intrinsics.cy),
          .inverse_fx = static_cast<float>(1.0 / intrinsics.fx),
          .inverse_fy = static_cast<float>(1.0 / intrinsics.fy)};
}

SurfacePlanes planes_of(const SurfaceMap& surface) { return planes<const float>(surface); }

MutableSurfacePlanes planes_of(SurfaceMap& surface) { return planes<float>(surface); }

VolumeView view_of(const TsdfVolume& volume) {
  assert(volume.side_blocks() < 1 << VolumeView::kSideBits);
  const BlockCoord& min = volume.min_block();
  return {.slots = volume.table(),
          .voxels = volume.first_voxel(),
          .table_side = volume.table_side(),
          .side_blocks = volume.side_blocks(),
          .min_block = {min.x, min.y, min.z},
          .truncation_vox = static_cast<float>(volume.config().truncation_vox)};
}

RigidMotion rigid_motion(const Pose& X_BA) {
  RigidMotion motion;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) motion.R[i][j] = static_cast<float>(X_BA.linear()(i, j));
    motion.t[i] = static_cast<float>(X_BA.translation()(i));
  }
  return motion;
}

}  // namespace kintsugi::mapper
