#pragma once

#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace kintsugi::viewer {

/// One quantity over the slices of a run, in order of x.
struct Chart {
  std::string title;  ///< what y is, with its unit
  std::vector<cv::Point2d> points;
};

/// The charts below each other, each with axes from 0 and round numbers along them.
cv::Mat3b draw_charts(std::span<const Chart> charts, const std::string& x_title, cv::Size size);

/// The smallest of 1, 2 and 5 times a power of ten that is at least `value`; 1 when `value` <= 0.
double round_up(double value);

}  // namespace kintsugi::viewer
