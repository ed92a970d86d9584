#pragma once

#include <cstdint>
#include <set>

#include <opencv2/core.hpp>

namespace kintsugi::viewer {

/// Segments that stand out in a picture; none: all look as ever.
using Highlight = std::set<std::uint32_t>;

/// The colour of what does not stand out: dark and nearly grey.
cv::Vec3b dimmed(const cv::Vec3b& color);

/// Draws a bright line around the pixels of `mask`.
void outline(cv::Mat3b& image, const cv::Mat1b& mask, int width_px);

}  // namespace kintsugi::viewer
