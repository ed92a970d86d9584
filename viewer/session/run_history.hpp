#pragma once

#include <opencv2/core.hpp>

#include "viewer/core/charts/chart.hpp"
#include "viewer/core/map/received_map.hpp"

namespace kintsugi::viewer {

/// Lag and times of a run over its slices: the charts of plots.png.
class RunHistory {
 public:
  void add_lag(const ReceivedMap& map);
  void add_slice_time(const SegmenterStatus& status);
  void add_render_time(const ReceivedMap& map, double render_ms);

  /// Draws the charts below each other; those of times only if there are any. `size` in pixels.
  cv::Mat3b draw(cv::Size size) const;

 private:
  Chart lag_{"lag of the segments behind the map, slices", {}};
  Chart slice_time_{"time of the segmenter for a slice, ms", {}};
  Chart render_time_{"time of the viewer for a picture, ms", {}};
};

}  // namespace kintsugi::viewer
