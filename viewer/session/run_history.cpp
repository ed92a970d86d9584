#include "viewer/session/run_history.hpp"

#include <vector>

namespace kintsugi::viewer {
namespace {

/// Appends a value, or replaces the last one when it belongs to the same slice. Smaller slice
/// counts are ignored: a restarted segmenter counts again from the map that it saved last.
void append(Chart& chart, std::int64_t slice, double value) {
  const auto x = static_cast<double>(slice);
  if (!chart.points.empty() && x < chart.points.back().x) return;
  if (!chart.points.empty() && chart.points.back().x == x) chart.points.pop_back();
  chart.points.emplace_back(x, value);
}

}  // namespace

void RunHistory::add_lag(const ReceivedMap& map) {
  append(lag_, map.counts().labelled_slices, static_cast<double>(map.lag_slices()));
}

void RunHistory::add_slice_time(const SegmenterStatus& status) {
  append(slice_time_, status.slices_segmented, status.slice_ms);
}

void RunHistory::add_render_time(const ReceivedMap& map, double render_ms) {
  append(render_time_, map.counts().slices, render_ms);
}

cv::Mat3b RunHistory::draw(cv::Size size) const {
  std::vector<Chart> charts{lag_};
  for (const Chart& chart : {slice_time_, render_time_}) {
    if (!chart.points.empty()) charts.push_back(chart);
  }
  return draw_charts(charts, "slice", size);
}

}  // namespace kintsugi::viewer
