#pragma once

#include <opencv2/core.hpp>

#include "viewer/core/charts/segment_timeline.hpp"

namespace kintsugi::viewer {

/// Draws the timeline of a segment, `size` in pixels: its number of points over the slices as an
/// area in its colour; above it a tag for its beginning and for each segment merged into it; below
/// it a tag for each segment split off and for its end. A tag has the id and the colour of the
/// other segment. Every event has a tick; if there is no room for all tags, those of the largest
/// segments are drawn. The time before the first update received is hatched.
cv::Mat3b draw_timeline(const SegmentTimeline& timeline, cv::Size size);

}  // namespace kintsugi::viewer
