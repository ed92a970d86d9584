#include "mapper/process/camera_views.hpp"

#include <cmath>
#include <limits>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace kintsugi::mapper {
namespace {

constexpr int kDepthWidth_px = 160;
constexpr int kColorWidth_px = 320;
constexpr int kJpegQuality = 80;
constexpr double kEarly = 0.9;  // of a period: the times of frames are not quite even

std::uint16_t in_mm(float depth_m) {
  const float depth_mm = std::round(1e3F * depth_m);
  constexpr auto kMax = static_cast<float>(std::numeric_limits<std::uint16_t>::max());
  return depth_mm > 0.0F && depth_mm <= kMax ? static_cast<std::uint16_t>(depth_mm) : 0;  // NaN: 0
}

/// Halved while at least `width_px` remain.
cv::Mat small_image(const cv::Mat& image, int width_px) {
  int factor = 1;
  while (image.cols / (2 * factor) >= width_px) factor *= 2;
  if (factor == 1) return image;
  cv::Mat result;
  cv::resize(image, result, {image.cols / factor, image.rows / factor}, 0, 0, cv::INTER_AREA);
  return result;
}

}  // namespace

std::optional<CameraView> CameraViews::next(const RgbdFrame& frame,
                                            const TrackingResult& tracking) {
  if (rate_hz_ <= 0.0) return std::nullopt;
  const auto period_us = static_cast<std::int64_t>(kEarly * 1e6 / rate_hz_);
  if (last_utime_ && frame.utime - *last_utime_ < period_us) return std::nullopt;
  last_utime_ = frame.utime;
  return make_camera_view(frame, tracking);
}

CameraView make_camera_view(const RgbdFrame& frame, const TrackingResult& tracking) {
  CameraView view;
  view.utime = frame.utime;
  view.frame_index = frame.frame_index;
  view.state = tracking.state;
  view.X_WC = tracking.X_WC;
  view.intrinsics = frame.intrinsics;
  while (frame.intrinsics.width / (2 * view.depth_step) >= kDepthWidth_px) view.depth_step *= 2;
  for (int j = 0; j < view.depth_height(); ++j) {
    const float* row_m = frame.depth_m[j * view.depth_step + view.depth_step / 2];
    for (int i = 0; i < view.depth_width(); ++i) {
      view.depth_mm.push_back(in_mm(row_m[i * view.depth_step + view.depth_step / 2]));
    }
  }
  if (frame.color_rgb.empty()) return view;
  cv::Mat color_bgr;
  cv::cvtColor(small_image(frame.color_rgb, kColorWidth_px), color_bgr, cv::COLOR_RGB2BGR);
  cv::imencode(".jpg", color_bgr, view.color_jpeg, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return view;
}

}  // namespace kintsugi::mapper
