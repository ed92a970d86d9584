#pragma once
// What was measured of a live run, for people and for programs.

#include <string>

#include "segmenter/evaluation/live/live_log.hpp"

namespace kintsugi::segmenter {

/// A Markdown table of the measures, with a line for each.
std::string to_markdown(const LiveLogReport& result, const LiveConfig& config);

/// One object: `log`, `session`, `is_whole`, `remarks`, and the measures. Shares are from 0 to 1;
/// null: nothing to measure.
std::string to_json(const LiveLogReport& result);

}  // namespace kintsugi::segmenter
