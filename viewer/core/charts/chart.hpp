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

}  // namespace kintsugi::viewer
