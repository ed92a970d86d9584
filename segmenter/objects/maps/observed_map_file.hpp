#pragma once
// Reads a segmented map together with what the camera saw.

#include <filesystem>

#include "segmenter/views/observed_map.hpp"

namespace kintsugi::segmenter {

/// How slices of a log are segmented: mode exact with the preset `objects`.
SegmentMapConfig default_map_config();

/// Reads a saved map and the views beside it (views_file_of()), or the slices and views of an LCM
/// log, which are segmented with `config`. Everything is where the last correction of the map has
/// put it. Of a map in several parts it is the part with most points, of a log with several
/// sessions the one with most slices. Without views, which is no error, `views` is empty.
/// @throws std::runtime_error naming the file, the place, the reason and what was expected
ObservedMap read_observed_map(const std::filesystem::path& path,
                              const SegmentMapConfig& config = default_map_config());

}  // namespace kintsugi::segmenter
