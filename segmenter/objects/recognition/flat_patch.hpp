#pragma once
// Surface that many things have.

#include "segmenter/objects/recognition/surface.hpp"

namespace kintsugi::segmenter {

/// Nearly all normals are one, but along a rim.
bool is_flat(const Surface& surface);

/// All colours are nearly one. What has none is plain.
bool is_plain(const Surface& surface);

}  // namespace kintsugi::segmenter
