#include "viewer/core/view/camera_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace kintsugi::viewer {
namespace {

/// Empty when there is none that can be decoded.
cv::Mat3b decode_color(const CameraView& view) {
  if (view.color_jpeg.empty()) return {};
  try {
    return cv::imdecode(view.color_jpeg, cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {  // bytes from the bus may be anything
    return {};
  }
}

/// Of the pixels of a picture along one axis: the two depths of the view that it lies between.
struct Sample {
  int first = 0;
  int second = 0;
  float share = 0.0F;  ///< of the way from the first to the second
  int nearest() const { return share < 0.5F ? first : second; }
};

std::vector<Sample> samples_along(int pixels, int image_pixels, int step, int depths) {
  std::vector<Sample> samples(static_cast<std::size_t>(pixels));
  const double scale = static_cast<double>(image_pixels) / pixels;
  const double offset = step / 2;  // NOLINT(bugprone-integer-division): so is CameraView's
  for (int i = 0; i < pixels; ++i) {
    const double at = (((i + 0.5) * scale - 0.5) - offset) / step;
    const double clamped = std::clamp(at, 0.0, depths - 1.0);
    const int first = std::min(static_cast<int>(clamped), std::max(depths - 2, 0));
    samples[static_cast<std::size_t>(i)] = {first, std::min(first + 1, depths - 1),
                                            static_cast<float>(clamped - first)};
  }
  return samples;
}

/// Depths that differ by less belong to one surface: neighbouring pixels of a plane at 80 degrees
/// to the line of sight differ by 4 % in a view with 160 depths over 57 degrees.
constexpr float kOneSurface = 0.05F;

float interpolate_mm(const cv::Mat1w& depth_mm, const Sample& x, const Sample& y) {
  const std::array<float, 4> mm{static_cast<float>(depth_mm(y.first, x.first)),
                                static_cast<float>(depth_mm(y.first, x.second)),
                                static_cast<float>(depth_mm(y.second, x.first)),
                                static_cast<float>(depth_mm(y.second, x.second))};
  const auto [least, most] = std::ranges::minmax(mm);
  if (least == 0.0F || most - least > kOneSurface * least) {
    return depth_mm(y.nearest(), x.nearest());
  }
  const float upper = (1.0F - x.share) / mm[0] + x.share / mm[1];
  const float lower = (1.0F - x.share) / mm[2] + x.share / mm[3];
  return 1.0F / ((1.0F - y.share) * upper + y.share * lower);
}

cv::Mat3b depth_in_grey(const MeasuredDepth& measured) {
  constexpr float kHalf_m = 2.0F;  // at this depth half as bright
  cv::Mat3b image(measured.depth_m.size(), cv::Vec3b());
  image.forEach([&](cv::Vec3b& pixel, const int* at) {
    const float depth_m = measured.depth_m(at[0], at[1]);
    if (depth_m > 0.0F) {
      pixel = cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(255.0F / (1.0F + depth_m / kHalf_m)));
    }
  });
  return image;
}

}  // namespace

VirtualCamera camera_of(const CameraView& view, cv::Size size) {
  VirtualCamera camera{view.intrinsics, view.X_WC};
  Intrinsics& k = camera.intrinsics;
  const double along_u = static_cast<double>(size.width) / k.width;
  const double along_v = static_cast<double>(size.height) / k.height;
  k.fx *= along_u;
  k.fy *= along_v;
  k.cx = along_u * (k.cx + 0.5) - 0.5;
  k.cy = along_v * (k.cy + 0.5) - 0.5;
  k.width = size.width;
  k.height = size.height;
  return camera;
}

cv::Mat3b camera_image(const CameraView& view, cv::Size size) {
  const cv::Mat3b color = decode_color(view);
  if (color.empty()) return depth_in_grey(measured_depth(view, size));
  cv::Mat3b image;
  const bool smaller = size.width < color.cols;
  cv::resize(color, image, size, 0.0, 0.0, smaller ? cv::INTER_AREA : cv::INTER_LINEAR);
  return image;
}

MeasuredDepth measured_depth(const CameraView& view, cv::Size size) {
  MeasuredDepth measured{cv::Mat1f(size, 0.0F)};
  const int width = view.depth_width();
  const int height = view.depth_height();
  if (width < 1 || height < 1) return measured;
  // cv::Mat takes no const data; this one is only read.
  const cv::Mat1w depth_mm(height, width, const_cast<std::uint16_t*>(view.depth_mm.data()));
  const Intrinsics& k = view.intrinsics;
  const std::vector<Sample> along_u = samples_along(size.width, k.width, view.depth_step, width);
  const std::vector<Sample> along_v = samples_along(size.height, k.height, view.depth_step, height);
  measured.depth_m.forEach([&](float& depth_m, const int* at) {
    const Sample& y = along_v[static_cast<std::size_t>(at[0])];
    const Sample& x = along_u[static_cast<std::size_t>(at[1])];
    depth_m = 0.001F * interpolate_mm(depth_mm, x, y);
  });
  return measured;
}

}  // namespace kintsugi::viewer
