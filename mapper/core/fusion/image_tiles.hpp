#pragma once
// Square tiles of an image, and which of them a sphere touches.

#include <algorithm>

namespace kintsugi::mapper {

/// Numbers of tiles along one axis of the image, both included.
struct TileSpan {
  int first = 0;
  int last = 0;
};

inline int num_tiles_along(int length_px, int side_px) {
  return (length_px + side_px - 1) / side_px;
}

/// The tiles that a sphere with its centre at (x, z), metres in C, touches along one axis of the
/// image. For a sphere that comes close to the camera or reaches behind it: all tiles.
inline TileSpan tiles_of_sphere(float x, float z, float radius_m, float focal_px,
                                float principal_px, int num_tiles, int side_px) {
  const float nearest_m = z - radius_m;
  if (nearest_m <= radius_m) return {.first = 0, .last = num_tiles - 1};
  const auto tile_at = [&](float tangent) {
    const float pixel = focal_px * tangent + principal_px + 0.5F;
    const float tile = pixel / static_cast<float>(side_px);
    return static_cast<int>(std::clamp(tile, 0.0F, static_cast<float>(num_tiles - 1)));
  };
  const float left = x - radius_m;
  const float right = x + radius_m;
  return {.first = tile_at(left / (left < 0 ? nearest_m : z + radius_m)),
          .last = tile_at(right / (right > 0 ? nearest_m : z + radius_m))};
}

}  // namespace kintsugi::mapper
