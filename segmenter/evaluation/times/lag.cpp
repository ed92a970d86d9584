#include "segmenter/evaluation/times/lag.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace kintsugi::segmenter {

std::vector<std::int64_t> slices_behind(std::span<const std::int64_t> ready_us,
                                        std::span<const double> run_ms) {
  if (ready_us.size() != run_ms.size()) {
    throw std::invalid_argument(std::to_string(ready_us.size()) + " slices are ready, " +
                                std::to_string(run_ms.size()) + " have a time: must be equal");
  }
  std::vector<std::int64_t> behind;
  std::vector<double> finished_us;  // ascending
  std::size_t num_finished = 0;     // when the slice is ready
  double ready = 0.0;
  for (std::size_t i = 0; i < run_ms.size(); ++i) {
    // Relative to the first, so that a double represents microseconds exactly.
    const auto own = static_cast<double>(ready_us[i] - ready_us[0]);
    ready = i == 0 ? own : std::max(ready, own);
    while (num_finished < i && finished_us[num_finished] <= ready) ++num_finished;
    behind.push_back(static_cast<std::int64_t>(i - num_finished));
    const double start = i == 0 ? ready : std::max(ready, finished_us.back());
    finished_us.push_back(start + 1e3 * run_ms[i]);
  }
  return behind;
}

LagSummary summarize_lag(std::span<const std::int64_t> slices_behind) {
  LagSummary summary;
  for (const std::int64_t count : slices_behind) {
    summary.max_slices = std::max(summary.max_slices, count);
    summary.mean_slices += static_cast<double>(count);
  }
  if (!slices_behind.empty()) summary.mean_slices /= static_cast<double>(slices_behind.size());
  return summary;
}

}  // namespace kintsugi::segmenter
