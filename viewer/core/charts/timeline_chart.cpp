#include "viewer/core/charts/timeline_chart.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "viewer/core/charts/axes.hpp"
#include "viewer/core/charts/chip_lane.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/drawing/text.hpp"

namespace kintsugi::viewer {
namespace {

using Event = SegmentTimeline::Event;
using EventType = SegmentTimeline::EventType;

constexpr double kSmallText = 0.45;

constexpr int kLeft_px = 130;
constexpr int kRight_px = 40;
constexpr int kHeading_px = 80;
constexpr int kAxisText_px = 42;
constexpr int kLineOfText_px = 18;

/// What comes to the segment stands above its area, what leaves it below.
bool is_incoming(EventType type) {
  return type == EventType::kCreated || type == EventType::kSplitOff ||
         type == EventType::kAbsorbed;
}

/// The segment's own beginning or end.
bool is_about_itself(const Event& event) {
  return event.type != EventType::kAbsorbed && event.type != EventType::kSplit;
}

std::string text_of(const Event& event) {
  switch (event.type) {
    case EventType::kCreated:
      return "created";
    case EventType::kSplitOff:
      return fmt::format("split off from {}", event.other_id);
    case EventType::kAbsorbed:
    case EventType::kSplit:
      return std::to_string(event.other_id);
    case EventType::kMergedInto:
      return fmt::format("merged into {}", event.other_id);
    case EventType::kRetired:
      return "retired";
  }
  return {};
}

/// What happened on one side of the segment, and the chips that tell of it.
struct Side {
  std::vector<Event> events;  ///< its own beginning or end first, then the largest others
  ChipLane lane;
};

Side side_of(const SegmentTimeline& timeline, const Axes& axes, bool incoming) {
  constexpr int kMaxRows = 6;
  std::vector<Event> events;
  std::ranges::copy_if(timeline.events, std::back_inserter(events),
                       [&](const Event& event) { return is_incoming(event.type) == incoming; });
  std::ranges::stable_sort(events, [](const Event& a, const Event& b) {
    if (is_about_itself(a) != is_about_itself(b)) return is_about_itself(a);
    return a.other_points > b.other_points;
  });
  std::vector<Chip> chips;
  chips.reserve(events.size());
  for (const Event& event : events) {
    const std::uint32_t id = event.other_id == kNoSegment ? timeline.segment_id : event.other_id;
    chips.push_back({axes.at(event.num_slices, 0.0).x, text_of(event), segment_color(id)});
  }
  const cv::Rect& area = axes.area();
  return {std::move(events), ChipLane(std::move(chips), area.x, area.br().x, kMaxRows)};
}

int height_of(const Side& side) {
  return std::max(3 * kLineOfText_px, side.lane.num_rows() * ChipLane::kRow_px) + 8;
}

/// A size holds for one slice more than it was said of, or until it changes.
Axes axes_in(const SegmentTimeline& timeline, const cv::Rect& area) {
  std::uint32_t max_points = 1;
  for (const auto& size : timeline.sizes) max_points = std::max(max_points, size.num_points);
  return {area, timeline.num_slices + 1.0, static_cast<double>(max_points)};
}

void draw_unheard(cv::Mat3b& image, const Axes& axes, double until) {
  constexpr int kStep_px = 10;
  const cv::Rect part(axes.area().tl(), axes.at(until, 0.0));
  if (part.empty()) return;
  cv::Mat3b unheard = image(part);
  for (int x = -part.height; x < part.width; x += kStep_px) {
    cv::line(unheard, {x, part.height}, {x + part.height, 0}, palette::kTimelineHatching, 1,
             cv::LINE_AA);
  }
  const std::string text = "not heard";
  const cv::Size size = text_size(text, kSmallText);
  if (size.width + 12 > part.width) return;
  draw_text(unheard, text, (cv::Point(part.size()) - cv::Point(size.width, -size.height)) / 2,
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

/// A small triangle at the edge of the chart for each event, so that none is missing.
void draw_ticks(cv::Mat3b& image, const Axes& axes, const SegmentTimeline& timeline) {
  for (const Event& event : timeline.events) {
    const int x = axes.at(event.num_slices, 0.0).x;
    const int y = is_incoming(event.type) ? axes.area().y : axes.area().br().y - 7;
    const std::array<cv::Point, 3> triangle{cv::Point(x - 5, y), {x + 5, y}, {x, y + 7}};
    const std::uint32_t id = event.other_id == kNoSegment ? timeline.segment_id : event.other_id;
    cv::fillConvexPoly(image, triangle, segment_color(id), cv::LINE_AA);
    cv::polylines(image, triangle, true, palette::kChartText, 1, cv::LINE_AA);
  }
}

/// How many other segments there are on this side, and of how many the id is to be read.
void draw_count(cv::Mat3b& image, const Side& side, const std::string& title, cv::Point at) {
  const auto is_other = [](const Event& event) { return !is_about_itself(event); };
  const auto num_others = std::ranges::count_if(side.events, is_other);
  const auto num_named = std::ranges::count_if(
      side.lane.places(), is_other,
      [&](const ChipLane::Place& place) -> const Event& { return side.events[place.chip]; });
  const cv::Point next_line(0, kLineOfText_px);
  draw_text(image, title, at, kSmallText, palette::kChartText);
  draw_text(image, with_thousands(num_others), at + next_line, kSmallText, palette::kChartText);
  if (num_named < num_others) {
    draw_text(image, fmt::format("largest {}", num_named), at + 2 * next_line, kSmallText,
              palette::kChartSecondaryText);
  }
}

std::string summary_of(const SegmentTimeline& timeline) {
  if (!timeline.is_known()) {
    return fmt::format("nothing was heard of it in {} slices", with_thousands(timeline.num_slices));
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
  const Side incoming = side_of(timeline, columns, true);
  const Side outgoing = side_of(timeline, columns, false);
  const int top = kHeading_px + height_of(incoming);
  const int bottom = size.height - kAxisText_px - height_of(outgoing);
  const Axes axes = axes_in(timeline, {kLeft_px, top, width, std::max(1, bottom - top)});

  draw_heading(image, timeline);
  incoming.lane.draw(image, ChipLane::Side::kAboveChart, top - 4, top);
  outgoing.lane.draw(image, ChipLane::Side::kBelowChart, bottom + kAxisText_px, bottom);
  axes.draw_grid(image);
  if (timeline.is_known()) {
    if (!timeline.has_beginning()) draw_unheard(image, axes, timeline.sizes.front().num_slices);
    draw_area(image, axes, timeline);
  }
  axes.draw_frame(image, "", "slices in the map");
  draw_text(image, "points", {12, top + 24}, kSmallText, palette::kChartText);
  draw_ticks(image, axes, timeline);
  draw_count(image, incoming, "absorbed", {12, kHeading_px + 12});
  draw_count(image, outgoing, "split off", {12, bottom + kAxisText_px + 12});
  return image;
}

}  // namespace kintsugi::viewer
