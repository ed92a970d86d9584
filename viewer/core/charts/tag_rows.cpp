#include "viewer/core/charts/tag_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "viewer/core/drawing/text.hpp"

namespace kintsugi::viewer {
namespace {

constexpr double kTextScale = 0.45;
constexpr int kPadding_px = 6;
constexpr int kGap_px = 4;  ///< between boxes, and between a box and a line

/// Dark or light, whichever is legible on the colour (luma as in ITU-R BT.601).
Rgb text_color_on(const Rgb& color) {
  const double brightness = 0.114 * color.blue + 0.587 * color.green + 0.299 * color.red;
  return brightness > 130.0 ? palette::kChartText : palette::kChartLightText;
}

bool is_over(const TagRows::Place& place, int x_px) {
  return x_px > place.left_px - kGap_px && x_px < place.left_px + place.width_px + kGap_px;
}

bool stand_side_by_side(const TagRows::Place& a, const TagRows::Place& b) {
  return a.left_px + a.width_px + kGap_px <= b.left_px ||
         b.left_px + b.width_px + kGap_px <= a.left_px;
}

}  // namespace

TagRows::TagRows(std::vector<Tag> tags, int left_px, int right_px, int max_rows)
    : tags_(std::move(tags)) {
  for (std::size_t i = 0; i < tags_.size(); ++i) find_place(i, left_px, right_px, max_rows);
}

bool TagRows::find_place(std::size_t tag, int left_px, int right_px, int max_rows) {
  // Where along its width a box has its moment.
  constexpr std::array kAlignments{0.5, 0.15, 0.85};
  const int width_px = text_size(tags_[tag].text, kTextScale).width + 2 * kPadding_px;
  for (int row = 0; row < max_rows; ++row) {
    for (const double alignment : kAlignments) {
      const int left = tags_[tag].x_px - static_cast<int>(std::lround(alignment * width_px));
      const Place place{tag, row, std::clamp(left, left_px, std::max(left_px, right_px - width_px)),
                        width_px};
      if (!is_free(place)) continue;
      places_.push_back(place);
      return true;
    }
  }
  return false;
}

bool TagRows::is_free(const Place& place) const {
  return std::ranges::all_of(places_, [&](const Place& other) {
    if (place.row == other.row) return stand_side_by_side(place, other);
    const int x_px = tags_[place.tag].x_px;
    const int other_x_px = tags_[other.tag].x_px;
    if (x_px == other_x_px) return true;
    return place.row < other.row ? !is_over(place, other_x_px) : !is_over(other, x_px);
  });
}

int TagRows::num_rows() const {
  int rows = 0;
  for (const Place& place : places_) rows = std::max(rows, place.row + 1);
  return rows;
}

void TagRows::draw(cv::Mat3b& image, Side side, int first_row_px, int chart_px) const {
  const auto box_of = [&](const Place& place) {
    const int rows_up = side == Side::kAboveChart ? place.row + 1 : -place.row;
    return cv::Rect(place.left_px, first_row_px - rows_up * kRow_px, place.width_px,
                    kRow_px - kGap_px);
  };
  for (const Place& place : places_) {
    const int x_px = tags_[place.tag].x_px;
    cv::line(image, {x_px, box_of(place).y}, {x_px, chart_px}, palette::kTimelineLeader);
  }
  for (const Place& place : places_) {
    const Tag& tag = tags_[place.tag];
    const cv::Rect box = box_of(place);
    cv::rectangle(image, box, tag.color, cv::FILLED);
    cv::rectangle(image, box, palette::kChartText);
    draw_text(image, tag.text, box.tl() + cv::Point(kPadding_px, 13), kTextScale,
              text_color_on(tag.color));
  }
}

}  // namespace kintsugi::viewer
