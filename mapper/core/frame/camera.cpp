#include "mapper/core/frame/camera.hpp"

#include <algorithm>
#include <string>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::mapper {
namespace {

std::string text_of(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

PinholeCamera pinhole_camera(const Intrinsics& intrinsics) {
  return {.width = intrinsics.width,
          .height = intrinsics.height,
          .fx = static_cast<float>(intrinsics.fx),
          .fy = static_cast<float>(intrinsics.fy),
          .cx = static_cast<float>(intrinsics.cx),
          .cy = static_cast<float>(intrinsics.cy),
          .inverse_fx = static_cast<float>(1.0 / intrinsics.fx),
          .inverse_fy = static_cast<float>(1.0 / intrinsics.fy)};
}

Intrinsics half_size(const Intrinsics& intrinsics) {
  Intrinsics half = intrinsics;
  half.fx /= 2.0;
  half.fy /= 2.0;
  half.cx = (intrinsics.cx + 0.5) / 2.0 - 0.5;
  half.cy = (intrinsics.cy + 0.5) / 2.0 - 0.5;
  half.width /= 2;
  half.height /= 2;
  return half;
}

void check_camera(const Intrinsics& intrinsics, const Pose& X_WC) {
  constexpr int kMaxPixels = 16384;
  check_range("width, pixels", intrinsics.width, 1, kMaxPixels);
  check_range("height, pixels", intrinsics.height, 1, kMaxPixels);
  check_range("fx, pixels", intrinsics.fx, 1.0, 100.0 * kMaxPixels);
  check_range("fy, pixels", intrinsics.fy, 1.0, 100.0 * kMaxPixels);
  check_range("cx, pixels", intrinsics.cx, -1.0 * kMaxPixels, 2.0 * kMaxPixels);
  check_range("cy, pixels", intrinsics.cy, -1.0 * kMaxPixels, 2.0 * kMaxPixels);
  const auto& distortion = intrinsics.distortion;
  require(std::all_of(distortion.begin(), distortion.end(), [](double k) { return k == 0.0; }),
          "the image has lens distortion, expected an undistorted one");
  require(X_WC.matrix().allFinite(), "X_WC has a number that is not finite");
}

void check_image_size(std::string_view name, cv::Size size, const Intrinsics& intrinsics) {
  require(size.width == intrinsics.width && size.height == intrinsics.height,
          std::string(name) + " is " + text_of(size.width, size.height) +
              ", its intrinsics are for " + text_of(intrinsics.width, intrinsics.height));
}

}  // namespace kintsugi::mapper
