#include "mapper/core/fusion/ray_tiles.hpp"

#include <algorithm>
#include <limits>

#include "mapper/core/fusion/image_tiles.hpp"
#include "mapper/core/volume/block_visibility.hpp"

namespace kintsugi::mapper {
std::vector<RaycastTile> find_ray_tiles(const TsdfVolume& volume, const PinholeCamera& camera,
                                        const Pose& X_WC, float min_depth_m, float max_depth_m) {
  const int num_columns = num_tiles_along(camera.width, RaycastTile::kSide_px);
  const int num_rows = num_tiles_along(camera.height, RaycastTile::kSide_px);
  std::vector<RaycastTile> tiles;
  tiles.reserve(static_cast<std::size_t>(num_columns) * num_rows);
  for (int row = 0; row < num_rows; ++row) {
    for (int column = 0; column < num_columns; ++column) {
      tiles.push_back({.u = column * RaycastTile::kSide_px,
                       .v = row * RaycastTile::kSide_px,
                       .near_m = std::numeric_limits<float>::max(),
                       .far_m = 0.0F});
    }
  }
  const float radius_m = block_radius_m(volume);
  for (const VisibleBlock& block : find_visible_blocks(volume, camera, X_WC, max_depth_m)) {
    const Eigen::Vector3f& center = block.center_C;
    const TileSpan columns = tiles_of_sphere(center.x(), center.z(), radius_m, camera.fx, camera.cx,
                                             num_columns, RaycastTile::kSide_px);
    const TileSpan rows = tiles_of_sphere(center.y(), center.z(), radius_m, camera.fy, camera.cy,
                                          num_rows, RaycastTile::kSide_px);
    const float near_m = std::max(min_depth_m, center.z() - radius_m);
    const float far_m = std::min(max_depth_m, center.z() + radius_m);
    for (int row = rows.first; row <= rows.last; ++row) {
      for (int column = columns.first; column <= columns.last; ++column) {
        RaycastTile& tile = tiles[row * num_columns + column];
        tile.near_m = std::min(tile.near_m, near_m);
        tile.far_m = std::max(tile.far_m, far_m);
      }
    }
  }
  return tiles;
}

}  // namespace kintsugi::mapper
