#pragma once
// When two points show the same surface of the same thing.

#include <algorithm>
#include <numbers>

#include "segmenter/objects/recognition/surface.hpp"

namespace kintsugi::segmenter {

/// Distances in multiples of the spacing of the surfaces. Two samplings of one surface lie up to
/// half a spacing apart on each side, and the map is registered to about as much.
inline constexpr float kSameDistance = 1.5F;
/// Cosine of 45 degrees: normals are averages over some voxels, so that at an edge between two
/// faces they lie anywhere between both.
inline constexpr float kSameNormal = std::numbers::sqrt2_v<float> / 2;
/// CIELAB. Colours of one surface in two maps differ by the light of the place where it stands, by
/// shades, and by what the sensor mixes at edges; above 2.3 a difference is just noticeable.
inline constexpr float kSameColor = 15.0F;

/// What the light of another place adds to all colours of a thing. It is bounded: else white and
/// grey things of one shape would be the same.
struct LightChange {
  Eigen::Vector3f lab = Eigen::Vector3f::Zero();

  static constexpr float kMaxLightness = 15.0F;
  static constexpr float kMaxTint = 8.0F;

  void limit() {
    lab.x() = std::clamp(lab.x(), -kMaxLightness, kMaxLightness);
    lab.y() = std::clamp(lab.y(), -kMaxTint, kMaxTint);
    lab.z() = std::clamp(lab.z(), -kMaxTint, kMaxTint);
  }
};

/// Points without colour say nothing about it.
inline bool same_color(const SurfacePoint& model, const SurfacePoint& seen,
                       const LightChange& light) {
  if (!model.has_color || !seen.has_color) return true;
  return (model.lab + light.lab - seen.lab).squaredNorm() <= kSameColor * kSameColor;
}

}  // namespace kintsugi::segmenter
