#pragma once
// A picture of what has changed.

#include <span>
#include <string>

#include "segmenter/objects/changes/map_changes.hpp"

namespace kintsugi::segmenter {

/// The map after from obliquely above, in parallel projection and in grey, with what is new in
/// green, what is gone in red, and what has moved in blue: light blue where it was. Ids of the
/// changes stand beside them. Returns a PNG file.
std::string change_picture_png(std::span<const MapChange> changes, const ObservedMap& after);

}  // namespace kintsugi::segmenter
