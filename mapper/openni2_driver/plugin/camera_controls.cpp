#include "mapper/openni2_driver/plugin/camera_controls.hpp"

#include <cmath>

#include "mapper/openni2_driver/plugin/property.hpp"

namespace kintsugi::mapper {

bool CameraControls::has(int property) {
  return property == ONI_STREAM_PROPERTY_AUTO_EXPOSURE ||
         property == ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE ||
         property == ONI_STREAM_PROPERTY_EXPOSURE || property == ONI_STREAM_PROPERTY_GAIN;
}

OniStatus CameraControls::get(int property, void* data, int* size) const {
  switch (property) {
    case ONI_STREAM_PROPERTY_AUTO_EXPOSURE:
      return give_property(auto_exposure_, data, size);
    case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE:
      return give_property(auto_white_balance_, data, size);
    case ONI_STREAM_PROPERTY_EXPOSURE:
      return give_property(exposure_, data, size);
    case ONI_STREAM_PROPERTY_GAIN:
      return give_property(gain_, data, size);
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus CameraControls::set(int property, const void* data, int size) {
  switch (property) {
    case ONI_STREAM_PROPERTY_AUTO_EXPOSURE:
      return take_property(data, size, auto_exposure_);
    case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE:
      return take_property(data, size, auto_white_balance_);
    case ONI_STREAM_PROPERTY_EXPOSURE:
      return take_property(data, size, exposure_);
    case ONI_STREAM_PROPERTY_GAIN:
      return take_property(data, size, gain_);
    default:
      return ONI_STATUS_NOT_SUPPORTED;
  }
}

cv::Mat CameraControls::expose(const cv::Mat& image, std::int64_t utime) {
  constexpr double kSwingPerSecond_rad = 7.0;
  const double swing = 0.2 * std::sin(kSwingPerSecond_rad * 1e-6 * static_cast<double>(utime));
  if (auto_exposure_ != FALSE) exposure_ = static_cast<int>(std::lround(100.0 * (1.0 + swing)));
  if (auto_white_balance_ != FALSE) red_ = 1.0 - swing;
  const double brightness = 1e-4 * exposure_ * gain_;
  cv::Mat exposed;
  cv::multiply(image, cv::Scalar(red_ * brightness, brightness, brightness), exposed);
  return exposed;
}

}  // namespace kintsugi::mapper
