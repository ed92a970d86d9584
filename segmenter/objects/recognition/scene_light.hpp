#pragma once
// The light of a place, by which all things in it look different at once.

#include <span>

#include "segmenter/objects/recognition/agreement.hpp"
#include "segmenter/objects/recognition/placement.hpp"

namespace kintsugi::segmenter {

/// What the light of a map changes of all colours beside those of the library, and how sure that
/// is.
struct SceneLight {
  Eigen::Vector3f log_gain = Eigen::Vector3f::Zero();  ///< as LightChange::log_gain
  /// Standard deviation of that of a single thing: things stand brighter or darker, and cameras
  /// adjust themselves.
  float deviation = 0.4F;

  /// From 0 to 1: how well the light that a placement assumes agrees.
  [[nodiscard]] float agreement(const LightChange& light) const;
};

/// The change on which most placements agree, which are of different objects or places: with three
/// or more it is known well, otherwise no change is assumed, with a large deviation.
/// @param placements by descending score
SceneLight light_of_scene(std::span<const Placement* const> placements);

}  // namespace kintsugi::segmenter
