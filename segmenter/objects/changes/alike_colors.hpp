#pragma once
// Whether two surfaces may be of one colour.

#include "segmenter/objects/recognition/surface.hpp"

namespace kintsugi::segmenter {

/// The light of both is alike, but for the shade that a thing is in: any of a third less to a half
/// more. Points without colour are alike to all.
bool are_alike_in_color(const SurfacePoint& a, const SurfacePoint& b);

}  // namespace kintsugi::segmenter
