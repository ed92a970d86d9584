#pragma once

#include <opencv2/core.hpp>

#include "viewer/core/charts/chart.hpp"
#include "viewer/core/scene/scene.hpp"

namespace kintsugi::viewer {

/// How a run went, slice by slice: what --plots shows.
class RunHistory {
 public:
  void add_lag(const Scene& scene);
  void add_slice_time(const SegmenterStatus& status);
  void add_render_time(const Scene& scene, double render_ms);

  cv::Mat3b draw(cv::Size size) const;

 private:
  Chart lag_{"lag of the segments behind the map, slices", {}};
  Chart slice_time_{"time of the segmenter for a slice, ms", {}};
  Chart render_time_{"time of the viewer for a picture, ms", {}};
};

}  // namespace kintsugi::viewer
