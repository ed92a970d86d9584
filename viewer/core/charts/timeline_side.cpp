#include "viewer/core/charts/timeline_side.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/drawing/text.hpp"

namespace kintsugi::viewer {
namespace {

using Event = SegmentTimeline::Event;
using EventType = SegmentTimeline::EventType;

constexpr int kTextLine_px = 18;

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

std::vector<Event> events_of(const SegmentTimeline& timeline, TimelineSide::Flow flow) {
  std::vector<Event> events;
  std::ranges::copy_if(timeline.events, std::back_inserter(events),
                       [&](const Event& event) { return flow_of(event) == flow; });
  std::ranges::stable_sort(events, [](const Event& a, const Event& b) {
    if (is_about_itself(a) != is_about_itself(b)) return is_about_itself(a);
    return a.other_points > b.other_points;
  });
  return events;
}

TagRows tags_of(const std::vector<Event>& events, const SegmentTimeline& timeline,
                const Axes& axes) {
  constexpr int kMaxRows = 6;
  std::vector<Tag> tags;
  tags.reserve(events.size());
  for (const Event& event : events) {
    tags.push_back({axes.at(event.num_slices, 0.0).x, text_of(event), color_of(event, timeline)});
  }
  return {std::move(tags), axes.area().x, axes.area().br().x, kMaxRows};
}

}  // namespace

TimelineSide::TimelineSide(const SegmentTimeline& timeline, const Axes& axes, Flow flow)
    : events_(events_of(timeline, flow)),
      side_(flow == Flow::kIn ? TagRows::Side::kAboveChart : TagRows::Side::kBelowChart),
      tags_(tags_of(events_, timeline, axes)) {}

int TimelineSide::height_px() const {
  return std::max(3 * kTextLine_px, tags_.num_rows() * TagRows::kRow_px) + 8;
}

void TimelineSide::draw_tags(cv::Mat3b& image, int first_row_px, int chart_px) const {
  tags_.draw(image, side_, first_row_px, chart_px);
}

void TimelineSide::draw_count(cv::Mat3b& image, const std::string& title, cv::Point at) const {
  constexpr double kTextScale = 0.45;
  const auto is_other = [](const Event& event) { return !is_about_itself(event); };
  const auto num_others = std::ranges::count_if(events_, is_other);
  const auto num_tagged = std::ranges::count_if(
      tags_.places(), is_other,
      [&](const TagRows::Place& place) -> const Event& { return events_[place.tag]; });
  const cv::Point next_line(0, kTextLine_px);
  draw_text(image, title, at, kTextScale, palette::kChartText);
  draw_text(image, with_thousands(num_others), at + next_line, kTextScale, palette::kChartText);
  if (num_tagged < num_others) {
    draw_text(image, fmt::format("largest {}", num_tagged), at + 2 * next_line, kTextScale,
              palette::kChartSecondaryText);
  }
}

TimelineSide::Flow flow_of(const Event& event) {
  const bool is_incoming = event.type == EventType::kCreated ||
                           event.type == EventType::kSplitOff || event.type == EventType::kAbsorbed;
  return is_incoming ? TimelineSide::Flow::kIn : TimelineSide::Flow::kOut;
}

Rgb color_of(const Event& event, const SegmentTimeline& timeline) {
  return segment_color(event.other_id == kNoSegment ? timeline.segment_id : event.other_id);
}

}  // namespace kintsugi::viewer
