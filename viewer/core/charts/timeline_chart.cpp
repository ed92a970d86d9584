#include "viewer/core/charts/timeline_chart.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "viewer/core/charts/axes.hpp"
#include "viewer/core/charts/timeline_side.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/drawing/text.hpp"

namespace kintsugi::viewer {
namespace {

constexpr double kSmallText = 0.45;

constexpr int kLeft_px = 130;
constexpr int kRight_px = 40;
constexpr int kHeading_px = 80;
constexpr int kAxisText_px = 42;

/// The x axis ends one slice after the last update, so that the last size has a width.
Axes axes_in(const SegmentTimeline& timeline, const cv::Rect& area) {
  std::uint32_t max_points = 1;
  for (const auto& size : timeline.sizes) max_points = std::max(max_points, size.num_points);
  return {area, timeline.num_slices + 1.0, static_cast<double>(max_points)};
}

void hatch_unknown(cv::Mat3b& image, const Axes& axes, double until) {
  constexpr int kStep_px = 10;
  const cv::Rect part(axes.area().tl(), axes.at(until, 0.0));
  if (part.empty()) return;
  cv::Mat3b unknown = image(part);
  for (int x = -part.height; x < part.width; x += kStep_px) {
    cv::line(unknown, {x, part.height}, {x + part.height, 0}, palette::kTimelineHatching, 1,
             cv::LINE_AA);
  }
  const std::string text = "not received";
  const cv::Size size = text_size(text, kSmallText);
  if (size.width + 12 > part.width) return;
  draw_text(unknown, text, (cv::Point(part.size()) - cv::Point(size.width, -size.height)) / 2,
            kSmallText, palette::kChartText);
}

void draw_area(cv::Mat3b& image, const Axes& axes, const SegmentTimeline& timeline) {
  const cv::Vec3b color = segment_color(timeline.segment_id);
  const cv::Vec3b background = palette::kChartBackground;
  const cv::Vec3b fill = 0.55 * cv::Vec3d(color) + 0.45 * cv::Vec3d(background);
  const cv::Scalar edge(0.6 * cv::Vec3d(color));
  std::vector<cv::Point> outline{axes.at(timeline.sizes.front().num_slices, 0.0)};
  for (std::size_t i = 0; i < timeline.sizes.size(); ++i) {
    const auto& [since, num_points] = timeline.sizes[i];
    const bool is_last = i + 1 == timeline.sizes.size();
    const int until = is_last ? timeline.num_slices + 1 : timeline.sizes[i + 1].num_slices;
    const cv::Rect step(axes.at(since, num_points), axes.at(until, 0.0));
    if (!step.empty()) cv::rectangle(image, step, fill, cv::FILLED);
    outline.push_back(axes.at(since, num_points));
    outline.push_back(axes.at(until, num_points));
  }
  cv::polylines(image, outline, false, edge, 2);
}

/// A small triangle at the edge of the chart for each event, also where its tag has no room.
void draw_ticks(cv::Mat3b& image, const Axes& axes, const SegmentTimeline& timeline) {
  for (const SegmentTimeline::Event& event : timeline.events) {
    const int x = axes.at(event.num_slices, 0.0).x;
    const bool is_above = flow_of(event) == TimelineSide::Flow::kIn;
    const int y = is_above ? axes.area().y : axes.area().br().y - 7;
    const std::array<cv::Point, 3> triangle{cv::Point(x - 5, y), {x + 5, y}, {x, y + 7}};
    cv::fillConvexPoly(image, triangle, color_of(event, timeline), cv::LINE_AA);
    cv::polylines(image, triangle, true, palette::kChartText, 1, cv::LINE_AA);
  }
}

std::string summary_of(const SegmentTimeline& timeline) {
  if (!timeline.is_known()) {
    return fmt::format("no update about it in {} slices", with_thousands(timeline.num_slices));
  }
  const auto& [since, num_points] = timeline.sizes.back();
  if (num_points == 0) return fmt::format("gone after {} slices", with_thousands(since));
  return fmt::format("{} points after {} slices", with_thousands(num_points),
                     with_thousands(timeline.num_slices));
}

void draw_heading(cv::Mat3b& image, const SegmentTimeline& timeline) {
  const cv::Rect swatch(12, 12, 30, 30);
  cv::rectangle(image, swatch, segment_color(timeline.segment_id), cv::FILLED);
  cv::rectangle(image, swatch, palette::kChartText);
  draw_text(image, fmt::format("segment {}", timeline.segment_id), {54, 36}, 0.85,
            palette::kChartText);
  draw_text(image, summary_of(timeline), {54, 62}, 0.5, palette::kChartSecondaryText);
}

}  // namespace

cv::Mat3b draw_timeline(const SegmentTimeline& timeline, cv::Size size) {
  cv::Mat3b image(size, palette::kChartBackground);
  const int width = std::max(1, size.width - kLeft_px - kRight_px);
  const Axes columns = axes_in(timeline, {kLeft_px, 0, width, 1});
  const TimelineSide incoming(timeline, columns, TimelineSide::Flow::kIn);
  const TimelineSide outgoing(timeline, columns, TimelineSide::Flow::kOut);
  const int top = kHeading_px + incoming.height_px();
  const int bottom = size.height - kAxisText_px - outgoing.height_px();
  const Axes axes = axes_in(timeline, {kLeft_px, top, width, std::max(1, bottom - top)});

  draw_heading(image, timeline);
  incoming.draw_tags(image, top - 4, top);
  outgoing.draw_tags(image, bottom + kAxisText_px, bottom);
  axes.draw_grid(image);
  if (timeline.is_known()) {
    if (!timeline.has_beginning()) hatch_unknown(image, axes, timeline.sizes.front().num_slices);
    draw_area(image, axes, timeline);
  }
  axes.draw_frame(image, "", "slices in the map");
  draw_text(image, "points", {12, top + 24}, kSmallText, palette::kChartText);
  draw_ticks(image, axes, timeline);
  incoming.draw_count(image, "absorbed", {12, kHeading_px + 12});
  outgoing.draw_count(image, "split off", {12, bottom + kAxisText_px + 12});
  return image;
}

}  // namespace kintsugi::viewer
