#include "viewer/core/drawing/text.hpp"

#include <cstddef>

#include <opencv2/imgproc.hpp>

namespace kintsugi::viewer {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;

int stroke_width(double scale) { return scale > 0.9 ? 2 : 1; }

}  // namespace

cv::Size text_size(const std::string& text, double scale) {
  int baseline = 0;
  return cv::getTextSize(text, kFont, scale, stroke_width(scale), &baseline);
}

void draw_text(cv::Mat3b& image, const std::string& text, cv::Point at, double scale,
               const Rgb& color) {
  cv::putText(image, text, at, kFont, scale, color, stroke_width(scale), cv::LINE_AA);
}

void draw_outlined_text(cv::Mat3b& image, const std::string& text, cv::Point at, double scale,
                        const Rgb& color) {
  cv::putText(image, text, at, kFont, scale, palette::kPictureTextEdge, stroke_width(scale) + 3,
              cv::LINE_AA);
  draw_text(image, text, at, scale, color);
}

std::string with_thousands(std::int64_t number) {
  std::string text = std::to_string(number);
  for (auto i = static_cast<std::ptrdiff_t>(text.size()) - 3; i > 0; i -= 3) {
    text.insert(static_cast<std::size_t>(i), 1, ' ');
  }
  return text;
}

}  // namespace kintsugi::viewer
