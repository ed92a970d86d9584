#include "mapper/source/openni2/openni2_intrinsics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "mapper/openni2_driver/recording/device_properties.hpp"
#include "mapper/source/openni2/openni2_modes.hpp"

namespace kintsugi::mapper {
namespace {

std::optional<Intrinsics> own_calibration(const openni::Device& device) {
  DeviceCalibration own{};
  int size = sizeof(own);
  if (!device.isPropertySupported(kDevicePropertyCalibration) ||
      device.getProperty(kDevicePropertyCalibration, &own, &size) != openni::STATUS_OK) {
    return std::nullopt;
  }
  Intrinsics intrinsics{.fx = own.fx,
                        .fy = own.fy,
                        .cx = own.cx,
                        .cy = own.cy,
                        .width = own.width,
                        .height = own.height,
                        .distortion = {}};
  std::ranges::copy(own.distortion, intrinsics.distortion.begin());
  return intrinsics;
}

double focal_length_px(int pixels, double field_of_view_rad) {
  return 0.5 * pixels / std::tan(0.5 * field_of_view_rad);
}

}  // namespace

Intrinsics intrinsics_of(const openni::Device& device, const openni::VideoStream& depth,
                         const openni::VideoStream* color) {
  if (const auto own = own_calibration(device)) return *own;
  const bool from_color = color != nullptr && color->getHorizontalFieldOfView() > 0.0F;
  const openni::VideoStream& camera = from_color ? *color : depth;
  const double width_rad = camera.getHorizontalFieldOfView();
  const double height_rad = camera.getVerticalFieldOfView();
  if (!(width_rad > 0.0 && height_rad > 0.0)) {
    throw std::runtime_error(std::string("device '") + device.getDeviceInfo().getUri() +
                             "' does not tell its field of view: give its calibration file");
  }
  const DeviceMode image = mode_of(depth);
  return {.fx = focal_length_px(image.width, width_rad),
          .fy = focal_length_px(image.height, height_rad),
          .cx = 0.5 * image.width,
          .cy = 0.5 * image.height,
          .width = image.width,
          .height = image.height,
          .distortion = {}};
}

}  // namespace kintsugi::mapper
