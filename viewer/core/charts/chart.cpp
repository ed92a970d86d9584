#include "viewer/core/charts/chart.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "viewer/core/charts/axes.hpp"
#include "viewer/core/drawing/palette.hpp"

namespace kintsugi::viewer {
namespace {

Axes axes_of(const Chart& chart, const cv::Rect& area) {
  double x_max = 1.0;
  double y_max = 1.0;
  for (const cv::Point2d& p : chart.points) {
    x_max = std::max(x_max, p.x);
    y_max = std::max(y_max, p.y);
  }
  return {area, x_max, y_max};
}

void draw_chart(cv::Mat3b& image, const cv::Rect& area, const Chart& chart,
                const std::string& x_title) {
  const Axes axes = axes_of(chart, area);
  axes.draw_grid(image);
  for (std::size_t i = 1; i < chart.points.size(); ++i) {
    cv::line(image, axes.at(chart.points[i - 1].x, chart.points[i - 1].y),
             axes.at(chart.points[i].x, chart.points[i].y), palette::kChartCurve, 1, cv::LINE_AA);
  }
  axes.draw_frame(image, chart.title, x_title);
}

}  // namespace

cv::Mat3b draw_charts(std::span<const Chart> charts, const std::string& x_title, cv::Size size) {
  constexpr int kLeft = 70;
  constexpr int kRight = 30;
  constexpr int kTop = 30;
  constexpr int kBottom = 45;
  cv::Mat3b image(size, palette::kChartBackground);
  const int height = size.height / std::max(1, static_cast<int>(charts.size()));
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const cv::Rect area(kLeft, static_cast<int>(i) * height + kTop,
                        std::max(1, size.width - kLeft - kRight),
                        std::max(1, height - kTop - kBottom));
    draw_chart(image, area, charts[i], x_title);
  }
  return image;
}

}  // namespace kintsugi::viewer
