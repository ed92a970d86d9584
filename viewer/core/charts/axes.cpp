#include "viewer/core/charts/axes.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "lcmtypes/base/text_format.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/drawing/text.hpp"

namespace kintsugi::viewer {
namespace {

constexpr double kTextScale = 0.45;

std::string number(double value) {
  const std::int64_t whole = std::llround(value);
  if (static_cast<double>(whole) == value) return with_thousands(whole);
  return format("%g", value);
}

void write_left_of(cv::Mat3b& image, const std::string& text, cv::Point at) {
  draw_text(image, text, at - cv::Point(text_size(text, kTextScale).width, 0), kTextScale,
            palette::kChartText);
}

}  // namespace

Axes::Axes(const cv::Rect& area, double x_max, double y_max)
    : area_(area),
      x_max_(std::max(1.0, x_max)),
      x_step_(round_up(x_max_ / 10.0)),
      y_step_(round_up(std::max(1.0, y_max) / 5.0)),
      y_max_(y_step_ * std::ceil(std::max(1.0, y_max) / y_step_)) {}

cv::Point Axes::at(double x, double y) const {
  return {area_.x + static_cast<int>(std::lround(x / x_max_ * area_.width)),
          area_.y + area_.height - static_cast<int>(std::lround(y / y_max_ * area_.height))};
}

void Axes::draw_grid(cv::Mat3b& image) const {
  for (int i = 0; i * x_step_ <= x_max_; ++i) {
    const double x = i * x_step_;
    cv::line(image, at(x, 0.0), at(x, y_max_), palette::kChartGrid);
    draw_text(image, number(x), at(x, 0.0) + cv::Point(-6, 16), kTextScale, palette::kChartText);
  }
  for (int i = 0; i * y_step_ <= y_max_; ++i) {
    const double y = i * y_step_;
    cv::line(image, at(0.0, y), at(x_max_, y), palette::kChartGrid);
    write_left_of(image, number(y), at(0.0, y) + cv::Point(-6, 5));
  }
}

void Axes::draw_frame(cv::Mat3b& image, const std::string& title,
                      const std::string& x_title) const {
  cv::rectangle(image, area_, palette::kChartText);
  draw_text(image, title, area_.tl() + cv::Point(0, -8), kTextScale, palette::kChartText);
  write_left_of(image, x_title, area_.br() + cv::Point(0, 32));
}

double round_up(double value) {
  if (!(value > 0.0)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= value * (1.0 - 1e-12)) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace kintsugi::viewer
