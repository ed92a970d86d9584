#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "viewer/core/rendering/id_image.hpp"

namespace kintsugi::viewer {

/// The id of a segment as it is written into a picture.
struct SegmentLabel {
  std::uint32_t segment_id = 0;
  cv::Point anchor;  ///< a pixel inside the visible part of the segment, near its centroid
  cv::Rect box;      ///< of the text; beside the segment where that is too small
  double scale = 0.0;
};

/// Places the ids of the segments with the most pixels, greedily from the largest on. No label or
/// leader line covers another label or a `reserved` box. Labels without a free place are left out,
/// and so are segments with fewer pixels than half a label.
///
/// @param only place only these segments, even if only a few pixels are visible; empty: all
std::vector<SegmentLabel> place_labels(const IdImage& ids, const std::set<std::uint32_t>& only,
                                       std::span<const cv::Rect> reserved);

/// Draws the ids, with leader lines from those beside their segment.
void draw_labels(cv::Mat3b& image, std::span<const SegmentLabel> labels);

}  // namespace kintsugi::viewer
