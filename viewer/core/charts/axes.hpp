#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace kintsugi::viewer {

/// Maps the values of a chart to its place in a picture; both axes begin at 0.
class Axes {
 public:
  /// The y axis ends at a round number that is at least `y_max`. Both maxima at least 1.
  Axes(const cv::Rect& area, double x_max, double y_max);

  cv::Point at(double x, double y) const;
  const cv::Rect& area() const { return area_; }
  double x_max() const { return x_max_; }

  /// Lines at round numbers, which are written beside them.
  void draw_grid(cv::Mat3b& image) const;
  /// The frame, over what was drawn, the title above and what x is below.
  void draw_frame(cv::Mat3b& image, const std::string& title, const std::string& x_title) const;

 private:
  cv::Rect area_;
  double x_max_;
  double x_step_;
  double y_step_;
  double y_max_;
};

/// The smallest of 1, 2 and 5 times a power of ten that is at least `value`; 1 when `value` <= 0.
double round_up(double value);

}  // namespace kintsugi::viewer
