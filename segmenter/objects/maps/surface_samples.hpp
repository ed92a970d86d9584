#pragma once
// The surface of a map, evenly and coarsely sampled.

#include <span>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// One point for each cell of `cell_m` and side of a surface: the mean of its points, their mean
/// normal and colour; `weight` is their number. Black points have no colour, and count for it only
/// where there are no others. Sorted by place, whatever the order of the points; points whose
/// normals cancel each other are left out.
std::vector<CloudPoint> surface_samples(std::span<const CloudPoint> points, double cell_m);

inline Eigen::Vector3f position_of(const CloudPoint& point) { return {point.x, point.y, point.z}; }
inline Eigen::Vector3f normal_of(const CloudPoint& point) { return {point.nx, point.ny, point.nz}; }
inline bool has_color(const CloudPoint& point) {
  return point.red != 0 || point.green != 0 || point.blue != 0;
}

}  // namespace kintsugi::segmenter
