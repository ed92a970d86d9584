#pragma once

#include <cstdint>
#include <string>

#include <opencv2/core.hpp>

#include "viewer/core/drawing/palette.hpp"

namespace kintsugi::viewer {

/// Size in pixels of a text of this scale: what draw_text() fills, without what hangs below.
cv::Size text_size(const std::string& text, double scale);

/// Writes `text` with its lower left corner at `at`.
void draw_text(cv::Mat3b& image, const std::string& text, cv::Point at, double scale,
               const Rgb& color);

/// The same with a dark edge around light letters, legible on every ground.
void draw_outlined_text(cv::Mat3b& image, const std::string& text, cv::Point at, double scale);

/// "1 234 567".
std::string with_thousands(std::int64_t number);

}  // namespace kintsugi::viewer
