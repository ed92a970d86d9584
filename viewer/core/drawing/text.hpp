#pragma once

#include <cstdint>
#include <string>

#include <opencv2/core.hpp>

#include "viewer/core/drawing/palette.hpp"

namespace kintsugi::viewer {

/// Width and height in pixels of a text, without the parts of letters below the baseline. `scale`
/// is the factor to the base size of OpenCV's font.
cv::Size text_size(const std::string& text, double scale);

/// Writes `text`; its baseline begins at `at`.
void draw_text(cv::Mat3b& image, const std::string& text, cv::Point at, double scale,
               const Rgb& color);

/// Writes light text with a dark outline, legible on any background.
void draw_outlined_text(cv::Mat3b& image, const std::string& text, cv::Point at, double scale,
                        const Rgb& color = palette::kPictureText);

/// The number with spaces between groups of three digits: "1 234 567".
std::string with_thousands(std::int64_t number);

}  // namespace kintsugi::viewer
