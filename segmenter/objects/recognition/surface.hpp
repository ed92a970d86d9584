#pragma once
// The surface of an object or of a part of a map, thinned to an even spacing: what recognition
// works on.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

struct SurfacePoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< metres
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit, towards free space
  Eigen::Vector3f lab = Eigen::Vector3f::Zero();       ///< CIELAB: L from 0 to 100, a, b
  bool has_color = false;
};

using Surface = std::vector<SurfacePoint>;

/// One point for each cube of the side `spacing_m` that has points: their mean position, normal and
/// colour. Points without a normal, and cubes whose normals cancel out, are left out. By ascending
/// cube: the result does not depend on the order of the points.
Surface thinned(std::span<const CloudPoint> points, float spacing_m);

/// Each point of the map as it is; those without a normal have the normal zero.
Surface unthinned(std::span<const CloudPoint> points);

/// The surface where `X_BA` puts it.
Surface transformed(const Surface& surface_A, const Pose& X_BA);

/// Half the diagonal of the box of the points, metres; 0 without points.
float radius_of(const Surface& surface);

/// About `count` of the points, evenly over the list.
Surface every_few(const Surface& surface, std::size_t count);

}  // namespace kintsugi::segmenter
