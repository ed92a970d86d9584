#pragma once

#include <ostream>
#include <vector>

#include "tests/bench/frame_run.hpp"

namespace kintsugi::mapper::bench {

/// Smallest value that at least `share` (0 to 1) of the values does not exceed; NaN without values.
double percentile(std::vector<double> values, double share);

/// A Markdown table of stages: for each run the wall time's median and 99th percentile and the mean
/// of the CPU time, milliseconds.
void print_stage_table(std::ostream& out, const std::vector<FrameRun>& runs);

}  // namespace kintsugi::mapper::bench
