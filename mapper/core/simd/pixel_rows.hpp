#pragma once

#include "mapper/core/kernels/pinhole_camera.hpp"

namespace kintsugi::mapper {

/// How many of the lanes of a pack are used, where `remaining` numbers are left.
template <typename Pack>
[[gnu::always_inline]] inline int lanes_until(int remaining) {
  return remaining < Pack::kNumLanes ? remaining : Pack::kNumLanes;
}

/// Of the rays (x, y, 1) of sixteen pixels of a row, from column `u` on, x.
template <typename Pack>
[[gnu::always_inline]] inline typename Pack::Float ray_x(const PinholeCamera& camera, int u) {
  using Float = typename Pack::Float;
  return (Float(static_cast<float>(u)) + Float::iota() - Float(camera.cx)) *
         Float(camera.inverse_fx);
}

/// Calls add(int pixel, int u, float y, int count) for each sixteen pixels of a row, and the rest:
/// `pixel` is the index of the first, `u` its column; their rays are (x, y, 1).
template <typename Pack, typename Add>
[[gnu::always_inline]] inline void for_pixels_of_row(const PinholeCamera& camera, int v,
                                                     const Add& add) {
  const float y = (static_cast<float>(v) - camera.cy) * camera.inverse_fy;
  for (int u = 0; u < camera.width; u += Pack::kNumLanes) {
    add(v * camera.width + u, u, y, lanes_until<Pack>(camera.width - u));
  }
}

}  // namespace kintsugi::mapper
