#pragma once
// How far the segmentation lags behind the mapper (Table II of the paper).

#include <cstdint>
#include <span>
#include <vector>

namespace kintsugi::segmenter {

/// Table II.
struct LagSummary {
  std::int64_t max_slices = 0;
  double mean_slices = 0.0;
};

/// How many slices the segmentation is behind: for each slice, the earlier ones that are not yet
/// segmented at the moment it is ready. Slice i is ready at `ready_us[i]`, and not before slice
/// i - 1; one slice is segmented at a time, in order, and takes `run_ms[i]`.
///
/// What arriving slices find is, over a whole run, also what finished slices leave behind: each
/// time the number passes from n to n + 1 it later passes back. So both ways of counting give the
/// same average and maximum.
/// @throws std::invalid_argument when the sizes differ
std::vector<std::int64_t> slices_behind(std::span<const std::int64_t> ready_us,
                                        std::span<const double> run_ms);

/// All zero for nothing.
LagSummary summarize_lag(std::span<const std::int64_t> slices_behind);

}  // namespace kintsugi::segmenter
