#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "lcmtypes/geometry.hpp"
#include "mapper/openni2_driver/recording/device_properties.hpp"
#include "mapper/source/frames/source_config.hpp"
#include "mapper/source/openni2/device_state.hpp"

namespace kintsugi::mapper {

/// A depth or a colour image of a device, whole and not mirrored.
struct DeviceImage {
  bool is_depth = true;
  std::int64_t utime = 0;  ///< device time, microseconds
  std::int64_t index = 0;  ///< as the device counts, in its own stream
  cv::Mat_<std::uint16_t> depth_raw;
  cv::Mat_<cv::Vec3b> color_rgb;  ///< on the depth image's pixels
};

/// An OpenNI2 device whose depth stream and, if it is aligned with depth, colour stream are
/// started.
///
/// Registers depth to colour where the device supports it, selects the depth unit that suits the
/// range, and undoes mirroring and cropping. To be used by one thread at a time. The first device
/// of the process initialises OpenNI2, the last one shuts it down.
class OpenNi2Device {
 public:
  /// @param uri as OpenNI2 lists it; empty: the first camera
  /// @throws std::runtime_error naming the device, with the message of OpenNI2
  OpenNi2Device(const std::string& uri, const SourceConfig& config);
  ~OpenNi2Device();
  OpenNi2Device(const OpenNi2Device&) = delete;
  OpenNi2Device& operator=(const OpenNi2Device&) = delete;

  /// The oldest image that waits; nullopt when none arrives within `timeout`.
  /// @throws std::runtime_error for an image that cannot be used
  std::optional<DeviceImage> wait(std::chrono::milliseconds timeout);

  /// Locks exposure and white balance of the colour camera at their present values.
  /// @return false when the device has no such settings
  bool lock_exposure();

  /// Stops the streams. To be called at the end of a file, because OpenNI2's file driver keeps a
  /// core busy from then until the streams are stopped.
  void stop();

  /// The state that the device reported last; earlier images may still wait to be read.
  [[nodiscard]] DeviceState state() const;

  /// Why state() is kFailed, if the device reports a reason.
  [[nodiscard]] std::string failure() const;

  /// Images of a recording that were passed over since it was opened; {} when the device is not
  /// ours.
  [[nodiscard]] UnreadImages unread_images() const;

  /// What a person should know about how the recording is read; empty: nothing.
  [[nodiscard]] std::string remark() const;

  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::string uri() const;
  [[nodiscard]] std::string serial_number() const;  ///< empty where the device has none
  [[nodiscard]] bool is_recording() const;
  [[nodiscard]] bool has_color() const;
  [[nodiscard]] std::optional<int> num_depth_frames() const;  ///< of a recording
  [[nodiscard]] double depth_units_per_m() const;
  [[nodiscard]] int depth_rate_hz() const;  ///< nominal, at least 1
  [[nodiscard]] cv::Size image_size() const;

  /// With the lens's distortion when the device is ours, and fy < 0 where its y axis points up;
  /// otherwise from the field of view alone
  /// (of the colour camera where depth is registered to it), the principal point in the middle.
  /// @throws std::runtime_error when the device does not provide them
  [[nodiscard]] Intrinsics intrinsics() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kintsugi::mapper
