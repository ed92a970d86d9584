#include "viewer/process/run_history.hpp"

#include <vector>

namespace kintsugi::viewer {
namespace {

/// Appends, or replaces the last value when it belongs to the same slice. A segmenter that was
/// restarted counts up to where it was again: that is no new history.
void append(Chart& chart, std::int64_t slice, double value) {
  const auto x = static_cast<double>(slice);
  if (!chart.points.empty() && x < chart.points.back().x) return;
  if (!chart.points.empty() && chart.points.back().x == x) chart.points.pop_back();
  chart.points.emplace_back(x, value);
}

}  // namespace

void RunHistory::add_lag(const Scene& scene) {
  append(lag_, scene.counts().labelled_slices, static_cast<double>(scene.lag_slices()));
}

void RunHistory::add_slice_time(const SegmenterStatus& status) {
  append(slice_time_, status.slices_segmented, status.slice_ms);
}

void RunHistory::add_render_time(const Scene& scene, double render_ms) {
  append(render_time_, scene.counts().slices, render_ms);
}

cv::Mat3b RunHistory::draw(cv::Size size) const {
  std::vector<Chart> charts{lag_};
  for (const Chart& chart : {slice_time_, render_time_}) {
    if (!chart.points.empty()) charts.push_back(chart);
  }
  return draw_charts(charts, "slice", size);
}

}  // namespace kintsugi::viewer
