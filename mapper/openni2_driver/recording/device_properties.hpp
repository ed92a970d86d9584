#pragma once
// Properties of our devices beyond those of OpenNI2. Read with openni::Device::getProperty();
// isPropertySupported() is false on all other devices.

#include <cstdint>
#include <type_traits>

namespace kintsugi::mapper {

/// A DeviceCalibration. OpenNI2 itself has only the field of view.
inline constexpr int kDevicePropertyCalibration = 0x4B530001;

/// Zero-terminated text, truncated to the buffer: why the playback ended early (device state
/// ERROR), else empty. OpenNI2's getExtendedError() is separate for each thread, so it cannot
/// report errors of the playing thread.
inline constexpr int kDevicePropertyPlaybackError = 0x4B530002;

/// An UnreadImages.
inline constexpr int kDevicePropertyUnreadImages = 0x4B530003;

/// Zero-terminated text, truncated to the buffer: what a person should know about how the recording
/// is read, else empty.
inline constexpr int kDevicePropertyRemark = 0x4B530004;

/// Images that were passed over since the device was opened, because they are missing or damaged.
struct UnreadImages {
  std::int32_t depth;
  std::int32_t color;
  char last_reason[504];  ///< zero-terminated; names the last file and what is wrong with it
};
static_assert(std::is_trivially_copyable_v<UnreadImages> && sizeof(UnreadImages) == 512);

/// Intrinsics of the depth images and of the colour images registered to them, as they leave the
/// device unmirrored and uncropped; the meaning of each field is that of kintsugi::Intrinsics. fy <
/// 0: C's y axis points up in the images.
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
