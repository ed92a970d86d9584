#include "mapper/core/fusion/ray_tiles.hpp"

#include <algorithm>
#include <limits>

#include "mapper/core/volume/block_visibility.hpp"

namespace kintsugi::mapper {
namespace {

/// Numbers of tiles along one axis of the image, both included.
struct Span {
  int first = 0;
  int last = 0;
};

/// The tiles that a sphere with its centre at (x, z), metres in C, touches along one axis of the
/// image. For a sphere that comes close to the camera or reaches behind it: all tiles.
Span tiles_of(float x, float z, float radius_m, float focal_px, float principal_px, int num_tiles) {
  const float nearest_m = z - radius_m;
  if (nearest_m <= radius_m) return {.first = 0, .last = num_tiles - 1};
  const auto tile_at = [&](float tangent) {
    const float pixel = focal_px * tangent + principal_px + 0.5F;
    const float tile = pixel / static_cast<float>(RaycastTile::kSide_px);
    return static_cast<int>(std::clamp(tile, 0.0F, static_cast<float>(num_tiles - 1)));
  };
  const float left = x - radius_m;
  const float right = x + radius_m;
  return {.first = tile_at(left / (left < 0 ? nearest_m : z + radius_m)),
          .last = tile_at(right / (right > 0 ? nearest_m : z + radius_m))};
}

int num_tiles_along(int length_px) {
  return (length_px + RaycastTile::kSide_px - 1) / RaycastTile::kSide_px;
}

}  // namespace

std::vector<RaycastTile> find_ray_tiles(const TsdfVolume& volume, const PinholeCamera& camera,
                                        const Pose& X_WC, float min_depth_m, float max_depth_m) {
  const int num_columns = num_tiles_along(camera.width);
  const int num_rows = num_tiles_along(camera.height);
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
    const Span columns =
        tiles_of(center.x(), center.z(), radius_m, camera.fx, camera.cx, num_columns);
    const Span rows = tiles_of(center.y(), center.z(), radius_m, camera.fy, camera.cy, num_rows);
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
