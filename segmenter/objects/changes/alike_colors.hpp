#pragma once
// Whether two surfaces may be of one colour.

#include "segmenter/objects/recognition/agreement.hpp"
#include "segmenter/objects/recognition/surface.hpp"

namespace kintsugi::segmenter {

/// In CIELAB. The light of both is alike, but for the shade that a thing is in: any of a third less
/// to a half more. Both have colour.
float color_distance(const SurfacePoint& a, const SurfacePoint& b);

/// Points without colour are alike to all.
bool are_alike_in_color(const SurfacePoint& a, const SurfacePoint& b, float within = kSameColor);

}  // namespace kintsugi::segmenter
