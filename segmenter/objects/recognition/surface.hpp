#pragma once
// The surface of an object or of a part of a map, thinned to an even spacing: what recognition
// works on.

#include <Eigen/Core>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

struct SurfacePoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< metres
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit, towards free space
  Eigen::Vector3f rgb = Eigen::Vector3f::Zero();       ///< linear, as light adds: 0 to 1
  Eigen::Vector3f lab = Eigen::Vector3f::Zero();  ///< the same in CIELAB: L from 0 to 100, a, b
  bool has_color = false;
};

using Surface = std::vector<SurfacePoint>;

/// One point for each cube of the side `spacing_m` that has points: their mean position and
/// normal, and the mean colour around it (smooth_colors()). Points without a normal, and cubes
/// whose normals cancel out, are left out. By ascending cube: the result does not depend on the
/// order of the points.
Surface thinned(std::span<const CloudPoint> points, float spacing_m);

/// The same, but colours are means over the cubes alone: in a small part of the time.
Surface roughly_thinned(std::span<const CloudPoint> points, float spacing_m);

/// The same of a surface, whose colours are means already.
Surface thinned(const Surface& surface, float spacing_m);

/// Each point of the map where it is, with its normal, which may be zero, and the colour as above.
/// @param spacing_m of the points
Surface unthinned(std::span<const CloudPoint> points, float spacing_m);

/// Cosine of 45 degrees: normals this close are of one face. They are averages over some voxels, so
/// that at an edge between two faces they lie anywhere between both.
inline constexpr float kSameNormal = std::numbers::sqrt2_v<float> / 2;

/// Colours are means over so much of a surface: about twelve points.
inline float color_radius_m(float spacing_m) { return 2 * spacing_m; }

/// Replaces each linear colour by the mean of those within `radius_m` on the same face
/// (kSameNormal), and CIELAB with it. Patterns as fine as the voxels come out differently in each
/// map; means of some voxels do not.
void smooth_colors(Surface& surface, float radius_m);

/// The surface as it would look if all light on it were multiplied by `gain` (red, green, blue).
void relight(Surface& surface, const Eigen::Array3f& gain);
void relight(std::span<CloudPoint> points, const Eigen::Array3f& gain);

/// The surface where `X_BA` puts it.
Surface transformed(const Surface& surface_A, const Pose& X_BA);

/// A linear colour in CIELAB, for the white of sRGB (D65).
Eigen::Vector3f lab_of(const Eigen::Vector3f& linear_rgb);

/// Half the diagonal of the box of the points, metres; 0 without points.
float radius_of(const Surface& surface);

/// About `count` of the points, evenly over the list.
Surface every_few(const Surface& surface, std::size_t count);

}  // namespace kintsugi::segmenter
