#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "viewer/core/charts/axes.hpp"
#include "viewer/core/charts/segment_timeline.hpp"
#include "viewer/core/charts/tag_rows.hpp"

namespace kintsugi::viewer {

/// The events on one side of a timeline and their tags: points come to the segment above its area
/// (created, split off, absorbed another) and leave it below (split, merged, retired).
class TimelineSide {
 public:
  enum class Flow { kIn, kOut };

  TimelineSide(const SegmentTimeline& timeline, const Axes& axes, Flow flow);

  int height_px() const;

  /// The row next to the chart begins at `first_row_px`, and the leader lines end at `chart_px`.
  void draw_tags(cv::Mat3b& image, int first_row_px, int chart_px) const;

  /// Writes how many other segments there are on this side, and how many of them have a tag.
  void draw_count(cv::Mat3b& image, const std::string& title, cv::Point at) const;

 private:
  std::vector<SegmentTimeline::Event>
      events_;  // beginning or end first, then by points, descending
  TagRows::Side side_;
  TagRows tags_;
};

/// The side on which an event is drawn.
TimelineSide::Flow flow_of(const SegmentTimeline::Event& event);

/// The colour of an event: that of the other segment, or of the timeline's own.
Rgb color_of(const SegmentTimeline::Event& event, const SegmentTimeline& timeline);

}  // namespace kintsugi::viewer
