#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

namespace kintsugi::viewer {

/// The segment id of what is seen in each pixel; kNoSegment: of none.
using IdImage = cv::Mat_<std::int32_t>;

/// Where the id of a segment is written.
struct SegmentLabel {
  std::uint32_t segment_id = 0;
  cv::Point anchor;  ///< pixel of the segment, well inside it and near its centre
  cv::Rect box;      ///< of the letters; beside the segment where it is too small or has no room
  double scale = 0.0;
};

/// Finds room for the ids of the segments with the most pixels; one by one, so that larger segments
/// have the better places. No label, nor the line that leads to it, covers another or what is
/// reserved; one that finds no room is left out, and so is a segment of which next to nothing is
/// seen.
///
/// @param only these segments, however little is seen of them; empty: all
std::vector<SegmentLabel> place_labels(const IdImage& ids, const std::set<std::uint32_t>& only,
                                       std::span<const cv::Rect> reserved);

void draw_labels(cv::Mat3b& image, std::span<const SegmentLabel> labels);

}  // namespace kintsugi::viewer
