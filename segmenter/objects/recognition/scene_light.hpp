#pragma once
// The light of a place, by which all things in it look different at once.

#include <numbers>
#include <span>

#include "segmenter/objects/recognition/agreement.hpp"
#include "segmenter/objects/recognition/placement.hpp"

namespace kintsugi::segmenter {

/// What the light of a map changes of all colours beside those of the library, and how sure that
/// is. Things stand brighter or darker, in the shadow or near a lamp, but the light of a place has
/// one colour.
struct SceneLight {
  Eigen::Vector3f log_gain = Eigen::Vector3f::Zero();  ///< as LightChange::log_gain
  bool is_known = false;                               ///< three placements or more agree
  /// Standard deviation of that of a single thing. As long as the light is not known it may be any
  /// that is allowed at all.
  float brightness_deviation = LightChange::kMaxBrightness;
  /// The same between channels: one may have more of the largest tint, and another one less.
  float tint_deviation = std::numbers::sqrt2_v<float> * LightChange::kMaxTint;

  /// From 0 to 1: how well the light that a placement assumes agrees.
  [[nodiscard]] float agreement(const LightChange& light) const;
};

/// The change on which most placements agree, which are of different objects or places: with three
/// or more it is known well, otherwise no change is assumed, with the largest deviation.
/// @param placements by descending score
SceneLight light_of_scene(std::span<const Placement* const> placements);

}  // namespace kintsugi::segmenter
