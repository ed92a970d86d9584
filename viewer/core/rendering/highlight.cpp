#include "viewer/core/rendering/highlight.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "viewer/core/drawing/palette.hpp"

namespace kintsugi::viewer {

cv::Vec3b dimmed(const cv::Vec3b& color) {
  constexpr double kBrightness = 0.45;
  constexpr double kChroma = 0.2;  // share that remains
  // Lightness as in HSL: with luminance, blue would be as dark as the background.
  const auto [darkest, brightest] = std::minmax({color[0], color[1], color[2]});
  const double grey = 0.5 * (darkest + brightest);
  return cv::Vec3b(kBrightness *
                   (kChroma * cv::Vec3d(color) + (1.0 - kChroma) * cv::Vec3d::all(grey)));
}

void outline(cv::Mat3b& image, const cv::Mat1b& mask, int width_px) {
  const cv::Size size(2 * width_px + 1, 2 * width_px + 1);
  cv::Mat1b grown;
  cv::dilate(mask, grown, cv::getStructuringElement(cv::MORPH_ELLIPSE, size));
  image.setTo(cv::Scalar(palette::kHighlightOutline), grown & ~mask);
}

}  // namespace kintsugi::viewer
