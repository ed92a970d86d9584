#pragma once
// Flags that the programs of the segmenter share.

#include <string>

#include <CLI/CLI.hpp>

#include "segmenter/map/segment_map.hpp"

namespace kintsugi::segmenter {

/// --mode, --audit, --threshold, --scale, --beta, --radius-factor and --neighbours, into `config`,
/// whose values are the defaults. Ranges are checked by config.validate().
void add_segmentation_options(CLI::App& app, SegmentMapConfig& config);

}  // namespace kintsugi::segmenter
