#pragma once
// What our devices tell beyond OpenNI2's own properties. Read with openni::Device::getProperty();
// isPropertySupported() is false on every other device.

#include <cstdint>
#include <type_traits>

namespace kintsugi::mapper {

/// DeviceCalibration: OpenNI2 itself knows only the field of view.
inline constexpr int kDevicePropertyCalibration = 0x4B530001;

/// Zero-terminated text, truncated to the buffer given: why the playback ended before its end
/// (device state ERROR), empty when it did not. OpenNI2's getExtendedError() is per thread and so
/// cannot carry what happens while frames are played.
inline constexpr int kDevicePropertyPlaybackError = 0x4B530002;

/// Intrinsics of the depth images and of the colour images registered to them, as they leave the
/// device unmirrored and uncropped; the meaning of each field is that of kintsugi::Intrinsics.
struct DeviceCalibration {
  double fx;
  double fy;
  double cx;
  double cy;
  double distortion[5];  ///< k1 k2 p1 p2 k3
  std::int32_t width;
  std::int32_t height;
};
static_assert(std::is_trivially_copyable_v<DeviceCalibration> && sizeof(DeviceCalibration) == 80);

}  // namespace kintsugi::mapper
