#include "mapper/core/volume/block_visibility.hpp"

#include <cmath>

namespace kintsugi::mapper {
namespace {

/// The four sides of a view: a point is inside where every signed distance is positive.
Eigen::Matrix<float, 4, 3> side_normals_C(const CameraView& view) {
  const float left = view.cx + 0.5F;
  const float right = static_cast<float>(view.width) - left;
  const float top = view.cy + 0.5F;
  const float bottom = static_cast<float>(view.height) - top;
  Eigen::Matrix<float, 4, 3> normals;
  normals << view.fx, 0, left,  //
      -view.fx, 0, right,       //
      0, view.fy, top,          //
      0, -view.fy, bottom;
  return normals.rowwise().normalized();
}

}  // namespace

float block_radius_m(const TsdfVolume& volume) {
  return volume.resolution_m() * (0.5F * kBlockSide) * std::sqrt(3.0F);
}

std::vector<VisibleBlock> find_visible_blocks(const TsdfVolume& volume, const CameraView& view,
                                              float max_depth_m) {
  const Eigen::Matrix<float, 4, 3> sides_C = side_normals_C(view);
  const float radius_m = block_radius_m(volume);
  const double block_m = volume.config().resolution_m * kBlockSide;
  const Eigen::Matrix3d blocks_to_C = view.X_CW.linear() * block_m;
  std::vector<VisibleBlock> visible;
  for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) {
    if (!volume.in_use(slot)) continue;
    const BlockCoord& coord = volume.coord(slot);
    const Eigen::Vector3d center_blocks(coord.x + 0.5, coord.y + 0.5, coord.z + 0.5);
    const Eigen::Vector3f center_C =
        (blocks_to_C * center_blocks + view.X_CW.translation()).cast<float>();
    if (center_C.z() < -radius_m || center_C.z() > max_depth_m + radius_m) continue;
    if ((sides_C * center_C).minCoeff() < -radius_m) continue;
    visible.push_back({.slot = slot, .center_C = center_C});
  }
  return visible;
}

}  // namespace kintsugi::mapper
