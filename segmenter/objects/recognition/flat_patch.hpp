#pragma once
// Surface that many things have.

#include "segmenter/objects/recognition/surface_moments.hpp"

namespace kintsugi::segmenter {

/// Nearly all normals are one, but along a rim.
bool is_flat(const SurfaceMoments& moments);

/// All colours are nearly one. What has none is plain.
bool is_plain(const SurfaceMoments& moments);

/// One flat patch of one colour.
bool is_flat_patch(const SurfaceMoments& moments);

}  // namespace kintsugi::segmenter
