#pragma once
// Flags that the programs of the segmenter share.

#include <string_view>

#include "segmenter/map/segment_map.hpp"

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

/// --mode, --audit, --preset (`default_preset` unless given), --threshold, --scale, --color-weight,
/// --min-points, --radius-factor, --beta and --neighbours, into `config`, whose other values are
/// the defaults. A value that is given counts, whatever the preset and wherever it stands. Ranges
/// are checked by config.validate().
void add_segmentation_options(CLI::App& app, SegmentMapConfig& config,
                              std::string_view default_preset = "objects");

}  // namespace kintsugi::segmenter
