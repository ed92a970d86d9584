#pragma once
// When two points show the same surface of the same thing.

#include <algorithm>

#include "segmenter/objects/recognition/surface.hpp"

namespace kintsugi::segmenter {

/// Distances in multiples of the spacing of the surfaces. Two samplings of one surface lie up to
/// half a spacing apart on each side, and the map is registered to about as much.
inline constexpr float kSameDistance = 1.5F;
/// Sine of 10 degrees: a surface that is seen flatter is hardly measured.
inline constexpr float kGrazing = 0.17F;
/// CIELAB. Colours of one surface in two maps differ by the light of the place where it stands, by
/// shades, and by what the sensor mixes at edges; above 2.3 a difference is just noticeable.
inline constexpr float kSameColor = 15.0F;

/// @param difference in CIELAB, between two points
inline bool is_same_color(const Eigen::Vector3f& difference) {
  return difference.squaredNorm() <= kSameColor * kSameColor;
}

/// The same on average over an object, in the light that is assumed there. Shades, noise and edges,
/// for which a single point may differ so much, cancel out for the most part; another colour does
/// not.
inline constexpr float kSameMeanColor = kSameColor / 3;

/// The light of another place multiplies the linear red, green and blue of all that it falls on.
struct LightChange {
  Eigen::Vector3f log_gain = Eigen::Vector3f::Zero();  ///< natural logarithms

  /// A factor of 2.7 in brightness, and of 1.6 between colours: from daylight to a bulb. Beyond, a
  /// white thing would be the same as a dark grey one, or as an orange one.
  static constexpr float kMaxBrightness = 1.0F;
  static constexpr float kMaxTint = 0.5F;

  void limit() {
    const float brightness = std::clamp(log_gain.mean(), -kMaxBrightness, kMaxBrightness);
    const Eigen::Array3f tint = (log_gain.array() - log_gain.mean()).max(-kMaxTint).min(kMaxTint);
    log_gain = (tint + brightness).matrix();
  }
};

}  // namespace kintsugi::segmenter
