#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace kintsugi::viewer {

/// Axes of a chart, both from 0: map values to pixels.
class Axes {
 public:
  /// `area` is in pixels. Maxima below 1 count as 1; the y axis ends at the next round number.
  Axes(const cv::Rect& area, double x_max, double y_max);

  cv::Point at(double x, double y) const;
  const cv::Rect& area() const { return area_; }

  /// Draws lines at round numbers, with the numbers beside them.
  void draw_grid(cv::Mat3b& image) const;
  /// Draws the frame, the title above and the title of the x axis below.
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
