#include "mapper/core/frame/camera_view.hpp"

#include <stdexcept>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::mapper {

CameraView::CameraView(const Intrinsics& intrinsics, const Pose& X_WC)
    : width(intrinsics.width),
      height(intrinsics.height),
      fx(static_cast<float>(intrinsics.fx)),
      fy(static_cast<float>(intrinsics.fy)),
      cx(static_cast<float>(intrinsics.cx)),
      cy(static_cast<float>(intrinsics.cy)),
      R_WC(X_WC.linear().cast<float>()),
      t_WC(X_WC.translation().cast<float>()),
      X_CW(X_WC.inverse()) {
  constexpr double kMaxPixels = 16384;
  check_range("width, pixels", width, 1, static_cast<int>(kMaxPixels));
  check_range("height, pixels", height, 1, static_cast<int>(kMaxPixels));
  check_range("fx, pixels", intrinsics.fx, 1.0, 100 * kMaxPixels);
  check_range("fy, pixels", intrinsics.fy, 1.0, 100 * kMaxPixels);
  check_range("cx, pixels", intrinsics.cx, -kMaxPixels, 2 * kMaxPixels);
  check_range("cy, pixels", intrinsics.cy, -kMaxPixels, 2 * kMaxPixels);
  for (const double coefficient : intrinsics.distortion) {
    if (coefficient != 0.0) {
      throw std::invalid_argument("the image has lens distortion, expected an undistorted one");
    }
  }
  if (!X_WC.matrix().allFinite()) {
    throw std::invalid_argument("X_WC has a number that is not finite");
  }
}

}  // namespace kintsugi::mapper
