#pragma once

#include <opencv2/core.hpp>

#include "viewer/core/charts/segment_timeline.hpp"

namespace kintsugi::viewer {

/// The life of a segment as a picture: its points over the slices as an area in its colour; above,
/// what it began from and what it absorbed; below, what left it and what it ended in. Each other
/// segment has its id and its colour. Where there are more of them than fit, the largest are
/// named; each has a tick.
cv::Mat3b draw_timeline(const SegmentTimeline& timeline, cv::Size size);

}  // namespace kintsugi::viewer
