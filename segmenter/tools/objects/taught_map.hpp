#pragma once

#include <filesystem>

#include "segmenter/views/observed_map.hpp"

namespace kintsugi::segmenter {

/// Reads a map from which objects are taught: a labelled PLY file with segment_id, whose resolution
/// is the median spacing of its points, or what read_observed_map() reads; the first bytes tell
/// which.
/// @throws std::runtime_error naming the file and the reason
ObservedMap read_taught_map(const std::filesystem::path& path);

}  // namespace kintsugi::segmenter
