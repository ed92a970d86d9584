#include "viewer/core/chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <opencv2/imgproc.hpp>

namespace kintsugi::viewer {
namespace {

const cv::Scalar kInk(40, 40, 40);
const cv::Scalar kGrid(225, 225, 225);
const cv::Scalar kLine(180, 90, 20);
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kTextScale = 0.45;

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

void write(cv::Mat3b& image, const std::string& text, cv::Point at) {
  cv::putText(image, text, at, kFont, kTextScale, kInk, 1, cv::LINE_AA);
}

void write_left_of(cv::Mat3b& image, const std::string& text, cv::Point at) {
  const int width = cv::getTextSize(text, kFont, kTextScale, 1, nullptr).width;
  write(image, text, {at.x - width, at.y});
}

/// Maps the values of one chart to its place in the picture.
struct Axes {
  cv::Rect area;
  double x_step = 1.0;
  double y_step = 1.0;
  double x_max = 1.0;
  double y_max = 1.0;

  Axes(const cv::Rect& chart_area, const std::vector<cv::Point2d>& points) : area(chart_area) {
    for (const cv::Point2d& p : points) {
      x_max = std::max(x_max, p.x);
      y_max = std::max(y_max, p.y);
    }
    x_step = round_up(x_max / 10.0);
    y_step = round_up(y_max / 5.0);
    y_max = y_step * std::ceil(y_max / y_step);
  }

  cv::Point at(double x, double y) const {
    return {area.x + static_cast<int>(std::lround(x / x_max * area.width)),
            area.y + area.height - static_cast<int>(std::lround(y / y_max * area.height))};
  }
};

void draw_chart(cv::Mat3b& image, const cv::Rect& area, const Chart& chart,
                const std::string& x_title) {
  const Axes axes(area, chart.points);
  for (int i = 0; i * axes.x_step <= axes.x_max; ++i) {
    const double x = i * axes.x_step;
    cv::line(image, axes.at(x, 0.0), axes.at(x, axes.y_max), kGrid);
    write(image, number(x), axes.at(x, 0.0) + cv::Point(-6, 16));
  }
  for (int i = 0; i * axes.y_step <= axes.y_max; ++i) {
    const double y = i * axes.y_step;
    cv::line(image, axes.at(0.0, y), axes.at(axes.x_max, y), kGrid);
    write_left_of(image, number(y), axes.at(0.0, y) + cv::Point(-6, 5));
  }
  cv::rectangle(image, area, kInk);
  for (std::size_t i = 1; i < chart.points.size(); ++i) {
    cv::line(image, axes.at(chart.points[i - 1].x, chart.points[i - 1].y),
             axes.at(chart.points[i].x, chart.points[i].y), kLine, 1, cv::LINE_AA);
  }
  write(image, chart.title, area.tl() + cv::Point(0, -8));
  write_left_of(image, x_title, area.br() + cv::Point(0, 32));
}

}  // namespace

double round_up(double value) {
  if (!(value > 0.0)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= value * (1.0 - 1e-12)) return factor * power;
  }
  return 10.0 * power;
}

cv::Mat3b draw_charts(std::span<const Chart> charts, const std::string& x_title, cv::Size size) {
  constexpr int kLeft = 70;
  constexpr int kRight = 30;
  constexpr int kTop = 30;
  constexpr int kBottom = 45;
  cv::Mat3b image(size, cv::Vec3b(255, 255, 255));
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
