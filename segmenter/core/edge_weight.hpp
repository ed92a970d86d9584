#pragma once

#include <algorithm>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Eq. 2 for the edge from point i to point j: c = 1 - n_i . n_j, squared where the surface is
/// convex
/// ((p_j - p_i) . n_j > 0). In double, each dot product summed as (x + y) + z, rounded once to
/// float32; c is clamped to >= 0, so a weight never is negative. Points and normals are finite.
inline float directed_edge_weight(const CloudPoint& i, const CloudPoint& j) {
  const auto dot = [](double ax, double ay, double az, double bx, double by, double bz) {
    return (ax * bx + ay * by) + az * bz;
  };
  const double c = std::max(0.0, 1.0 - dot(i.nx, i.ny, i.nz, j.nx, j.ny, j.nz));
  const double rise = dot(static_cast<double>(j.x) - i.x, static_cast<double>(j.y) - i.y,
                          static_cast<double>(j.z) - i.z, j.nx, j.ny, j.nz);
  return static_cast<float>(rise > 0.0 ? c * c : c);
}

/// The weight of the undirected edge. Algorithm 2 inserts both directions; the smaller of the two
/// alone gives the same partition, because an edge is either joined at its first chance or one of
/// its sides has frozen for good.
inline float edge_weight(const CloudPoint& a, const CloudPoint& b) {
  return std::min(directed_edge_weight(a, b), directed_edge_weight(b, a));
}

}  // namespace kintsugi::segmenter
