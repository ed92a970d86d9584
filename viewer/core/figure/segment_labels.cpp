#include "viewer/core/figure/segment_labels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <unordered_map>

#include <opencv2/imgproc.hpp>

#include "lcmtypes/messages.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/drawing/text.hpp"

namespace kintsugi::viewer {
namespace {

constexpr std::size_t kMaxLabels = 60;
constexpr int kMargin_px = 3;  ///< around the letters

/// The visible part of a segment.
struct VisibleSegment {
  std::uint32_t id = 0;
  int num_pixels = 0;
  cv::Point2d sum;
  float clearance_px = 0.0F;  ///< largest distance of one of its pixels from its edge
  cv::Point anchor;
  double anchor_distance_px = INFINITY;  ///< from the centroid

  cv::Point2d centroid() const { return sum / num_pixels; }
};

template <class Function>
void for_each_pixel(const IdImage& ids, Function&& function) {
  for (int v = 0; v < ids.rows; ++v) {
    for (int u = 0; u < ids.cols; ++u) {
      const auto id = static_cast<std::uint32_t>(ids(v, u));
      if (id != kNoSegment) function(cv::Point(u, v), id);
    }
  }
}

/// Distance of each pixel from the nearest pixel of another segment or the edge of the picture.
cv::Mat1f clearance_of(const IdImage& ids) {
  cv::Mat1b inside(ids.size(), std::uint8_t{0});
  for (int v = 1; v + 1 < ids.rows; ++v) {
    for (int u = 1; u + 1 < ids.cols; ++u) {
      const std::int32_t id = ids(v, u);
      const bool is_inside =
          id == ids(v - 1, u) && id == ids(v + 1, u) && id == ids(v, u - 1) && id == ids(v, u + 1);
      inside(v, u) = is_inside ? 1 : 0;
    }
  }
  cv::Mat1f clearance;
  cv::distanceTransform(inside, clearance, cv::DIST_L2, cv::DIST_MASK_3);
  return clearance;
}

/// Anchor: the pixel nearest to the centroid among those with a clearance of `enough_px`, or of the
/// segment's largest clearance where that is less.
std::vector<VisibleSegment> visible_segments(const IdImage& ids, float enough_px) {
  const cv::Mat1f clearance = clearance_of(ids);
  std::unordered_map<std::uint32_t, VisibleSegment> seen;
  for_each_pixel(ids, [&](cv::Point pixel, std::uint32_t id) {
    VisibleSegment& segment = seen[id];
    segment.id = id;
    ++segment.num_pixels;
    segment.sum += cv::Point2d(pixel);
    segment.clearance_px = std::max(segment.clearance_px, clearance(pixel));
  });
  for_each_pixel(ids, [&](cv::Point pixel, std::uint32_t id) {
    VisibleSegment& segment = seen[id];
    if (clearance(pixel) < std::min(enough_px, segment.clearance_px)) return;
    const double distance_px = cv::norm(cv::Point2d(pixel) - segment.centroid());
    if (distance_px >= segment.anchor_distance_px) return;
    segment.anchor_distance_px = distance_px;
    segment.anchor = pixel;
  });
  std::vector<VisibleSegment> largest_first;
  largest_first.reserve(seen.size());
  for (const auto& [id, segment] : seen) largest_first.push_back(segment);
  std::ranges::sort(largest_first, [](const VisibleSegment& a, const VisibleSegment& b) {
    return a.num_pixels != b.num_pixels ? a.num_pixels > b.num_pixels : a.id < b.id;
  });
  return largest_first;
}

/// Places for a label of this size, best first: on the segment, if it is larger than the label,
/// then around it at growing distances.
std::vector<cv::Rect> candidates(const VisibleSegment& segment, cv::Size letters) {
  constexpr int kDirections = 8;
  constexpr double kFarthest = 6.0;  // heights of the letters
  const auto around = [&](cv::Point2d center) {
    return cv::Rect(cv::Point(center) - cv::Point(letters / 2), letters);
  };
  std::vector<cv::Rect> boxes;
  if (segment.clearance_px >= 0.7F * static_cast<float>(letters.height)) {
    boxes.push_back(around(segment.anchor));
  }
  for (double distance = 1.5; distance <= kFarthest; distance += 0.75) {
    for (int i = 0; i < kDirections; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * (i + 0.5) / kDirections;
      const cv::Point2d reach(0.5 * letters.width + distance * letters.height,
                              distance * letters.height);
      boxes.push_back(
          around(cv::Point2d(segment.anchor) +
                 cv::Point2d(reach.x * std::cos(angle_rad), -reach.y * std::sin(angle_rad))));
    }
  }
  return boxes;
}

cv::Rect with_margin(const cv::Rect& box) {
  return box - cv::Point(kMargin_px, kMargin_px) + cv::Size(2 * kMargin_px, 2 * kMargin_px);
}

/// The line from a segment to its label.
struct Leader {
  cv::Point from;
  cv::Point to;

  bool crosses(const cv::Rect& box) const {
    cv::Point a = from;
    cv::Point b = to;
    return cv::clipLine(box, a, b);
  }
};

/// Nothing when the label is on the segment.
std::optional<Leader> leader_of(cv::Point anchor, const cv::Rect& box) {
  if (box.contains(anchor)) return std::nullopt;
  const cv::Rect wide = with_margin(box);
  return Leader{
      anchor,
      {std::clamp(anchor.x, wide.x, wide.br().x), std::clamp(anchor.y, wide.y, wide.br().y)}};
}

/// Parts of the picture that new labels must not cover.
struct Taken {
  std::vector<cv::Rect> boxes;
  std::vector<Leader> leaders;

  bool is_free(const cv::Rect& box, const std::optional<Leader>& leader) const {
    const auto is_in_the_way = [&](const cv::Rect& other) {
      return !(box & other).empty() || (leader && leader->crosses(other));
    };
    return std::ranges::none_of(boxes, is_in_the_way) &&
           std::ranges::none_of(leaders, [&](const Leader& other) { return other.crosses(box); });
  }
  void add(const cv::Rect& box, const std::optional<Leader>& leader) {
    boxes.push_back(box);
    if (leader) leaders.push_back(*leader);
  }
};

}  // namespace

std::vector<SegmentLabel> place_labels(const IdImage& ids, const std::set<std::uint32_t>& only,
                                       std::span<const cv::Rect> reserved) {
  const double scale = std::clamp(ids.cols / 1800.0, 0.42, 1.2);
  const cv::Size usual = text_size("0000", scale);
  const cv::Rect picture(cv::Point(), ids.size());
  Taken taken{{reserved.begin(), reserved.end()}, {}};
  std::vector<SegmentLabel> labels;
  for (const VisibleSegment& segment :
       visible_segments(ids, 0.5F * static_cast<float>(usual.width))) {
    if (labels.size() == kMaxLabels) break;
    if (only.empty() ? segment.num_pixels < usual.area() / 2 : !only.contains(segment.id)) continue;
    const cv::Size letters = text_size(std::to_string(segment.id), scale);
    for (const cv::Rect& box : candidates(segment, letters)) {
      const cv::Rect wide = with_margin(box);
      const auto leader = leader_of(segment.anchor, box);
      if ((wide & picture) != wide || !taken.is_free(wide, leader)) continue;
      labels.push_back({segment.id, segment.anchor, box, scale});
      taken.add(wide, leader);
      break;
    }
  }
  return labels;
}

void draw_labels(cv::Mat3b& image, std::span<const SegmentLabel> labels) {
  for (const SegmentLabel& label : labels) {
    const auto leader = leader_of(label.anchor, label.box);
    if (!leader) continue;
    cv::line(image, leader->from, leader->to, palette::kPictureTextEdge, 3, cv::LINE_AA);
    cv::line(image, leader->from, leader->to, palette::kPictureText, 1, cv::LINE_AA);
    cv::circle(image, leader->from, 3, palette::kPictureTextEdge, cv::FILLED, cv::LINE_AA);
    cv::circle(image, leader->from, 2, palette::kPictureText, cv::FILLED, cv::LINE_AA);
  }
  for (const SegmentLabel& label : labels) {
    const cv::Point lower_left(label.box.x, label.box.br().y);
    draw_outlined_text(image, std::to_string(label.segment_id), lower_left, label.scale);
  }
}

}  // namespace kintsugi::viewer
