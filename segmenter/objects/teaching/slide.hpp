#pragma once

#include <span>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"
#include "segmenter/objects/recognition/agreement.hpp"

namespace kintsugi::segmenter {

/// Where two observations share only two sides of an object, closest points leave one direction to
/// chance: along it only the ends of the surfaces tell. So the lesson is slid over the level plane
/// to where most is in both, to the middle of such places. It stays where no place has a hundredth
/// more.
/// @param known_O, lesson_L points of both, in frames with z up; neither is empty
/// @param X_OL about right
/// @param light what the lesson has more
/// @param spacing_m the larger of the spacings of the points
Pose slid(std::span<const CloudPoint> known_O, std::span<const CloudPoint> lesson_L,
          const Pose& X_OL, const LightChange& light, float spacing_m);

}  // namespace kintsugi::segmenter
