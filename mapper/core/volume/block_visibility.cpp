#include "mapper/core/volume/block_visibility.hpp"

#include <cmath>

namespace kintsugi::mapper {
namespace {

/// Normals of the four sides of the view frustum, pointing inwards.
Eigen::Matrix<float, 4, 3> side_normals_C(const PinholeCamera& camera) {
  const float left = camera.cx + 0.5F;
  const float right = static_cast<float>(camera.width) - left;
  const float top = camera.cy + 0.5F;
  const float bottom = static_cast<float>(camera.height) - top;
  Eigen::Matrix<float, 4, 3> normals;
  normals << camera.fx, 0, left,  //
      -camera.fx, 0, right,       //
      0, camera.fy, top,          //
      0, -camera.fy, bottom;
  return normals.rowwise().normalized();
}

}  // namespace

float block_radius_m(const TsdfVolume& volume) {
  return volume.resolution_m() * (0.5F * kBlockSide) * std::sqrt(3.0F);
}

std::vector<VisibleBlock> find_visible_blocks(const TsdfVolume& volume, const PinholeCamera& camera,
                                              const Pose& X_WC, float max_depth_m) {
  const Pose X_CW = X_WC.inverse();  // in double precision: positions in W can be large
  const Eigen::Matrix<float, 4, 3> sides_C = side_normals_C(camera);
  const float radius_m = block_radius_m(volume);
  const double block_m = volume.config().resolution_m * kBlockSide;
  const Eigen::Matrix3d blocks_to_C = X_CW.linear() * block_m;
  std::vector<VisibleBlock> visible;
  for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) {
    if (!volume.in_use(slot)) continue;
    const BlockCoord& coord = volume.coord(slot);
    const Eigen::Vector3d center_blocks(coord.x + 0.5, coord.y + 0.5, coord.z + 0.5);
    const Eigen::Vector3f center_C =
        (blocks_to_C * center_blocks + X_CW.translation()).cast<float>();
    if (center_C.z() < -radius_m || center_C.z() > max_depth_m + radius_m) continue;
    if ((sides_C * center_C).minCoeff() < -radius_m) continue;
    visible.push_back({.slot = slot, .center_C = center_C});
  }
  return visible;
}

}  // namespace kintsugi::mapper
