#include "lcmtypes/codec/intrinsics.hpp"

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::codec {

void check_intrinsics(const Check& check, const Intrinsics& intrinsics) {
  constexpr double kMax_px = kMaxImageSide_px;
  check.range("width", intrinsics.width, 1, kMaxImageSide_px);
  check.range("height", intrinsics.height, 1, kMaxImageSide_px);
  // No camera has a focal length below a pixel, or a principal point far outside the image.
  check.range("fx", intrinsics.fx, 1.0, 10.0 * kMax_px);
  check.range("fy", intrinsics.fy, 1.0, 10.0 * kMax_px);
  check.range("cx", intrinsics.cx, -kMax_px, 2.0 * kMax_px);
  check.range("cy", intrinsics.cy, -kMax_px, 2.0 * kMax_px);
  for (const double coefficient : intrinsics.distortion) {
    check.range("distortion", coefficient, -1e3, 1e3);
  }
}

}  // namespace kintsugi::codec
