#pragma once
// Flags that the programs of the segmenter share.

#include <string_view>

#include <CLI/CLI.hpp>

#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {

/// Adds --mode, --audit, --preset (`default_preset` unless given), --neighbours and an option for
/// each of kMapParameters that does not come with slices. They set `config`; a parameter that is
/// given counts, whatever the preset and wherever in the line it stands. Bounds are checked by
/// config.validate().
void add_segmentation_options(CLI::App& app, SegmentMapConfig& config,
                              std::string_view default_preset = "objects");

}  // namespace kintsugi::segmenter
