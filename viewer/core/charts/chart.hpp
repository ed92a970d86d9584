#pragma once

#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace kintsugi::viewer {

/// A curve through points in order of x.
struct Chart {
  std::string title;  ///< quantity and unit of y
  std::vector<cv::Point2d> points;
};

/// Draws the charts below each other, with the same title for each x axis; `size` in pixels.
cv::Mat3b draw_charts(std::span<const Chart> charts, const std::string& x_title, cv::Size size);

}  // namespace kintsugi::viewer
