#pragma once

#include <cstdint>
#include <set>

#include <opencv2/core.hpp>

namespace kintsugi::viewer {

/// Ids of the segments that stand out in a picture; empty: nothing is dimmed.
using Highlight = std::set<std::uint32_t>;

/// The pixel of a point that is not highlighted: dark and nearly grey.
cv::Vec3b dimmed(const cv::Vec3b& color);

/// Draws a line of this width around the pixels of `mask`.
void outline(cv::Mat3b& image, const cv::Mat1b& mask, int width_px);

}  // namespace kintsugi::viewer
