#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "lcmtypes/base/patient_clock.hpp"
#include "mapper/source/frames/color_clock.hpp"
#include "mapper/source/frames/device_clock.hpp"
#include "mapper/source/frames/frame_converter.hpp"
#include "mapper/source/frames/frame_pairer.hpp"
#include "mapper/source/frames/frame_source.hpp"
#include "mapper/source/openni2/camera_return.hpp"
#include "mapper/source/openni2/openni2_device.hpp"
#include "mapper/source/openni2/unread_count.hpp"

namespace kintsugi::mapper {

/// Frames from OpenNI2: a camera, a .oni file, or a device of our driver (folder://, synthetic://).
///
/// A camera that is disconnected is waited for, and frames continue when it is back. A truncated
/// .oni file is read up to its last complete record, by way of a repaired temporary copy.
class OpenNi2Source : public FrameSource {
 public:
  /// @throws std::runtime_error naming the device or file and what is wrong with it or with its
  ///   calibration
  explicit OpenNi2Source(const SourceConfig& config);

  std::optional<RgbdFrame> next() override;
  [[nodiscard]] SourceStatus status() const override;

 private:
  using Clock = std::chrono::steady_clock;

  void tell_how_it_is_read(bool y_points_up);
  void read_image();
  void count_unread();
  void look_for_depth(const RgbdFrame& frame);
  void warn_of_no_depth();
  void add(DeviceImage image);
  void compare_clocks(std::int64_t depth_utime);
  std::int64_t continuous_index(std::int64_t index);
  void lock_exposure_when_due(std::int64_t stamp_us);
  void check_for_end(DeviceState state_before);
  void check_for_silence();
  void interrupt(const std::string& reason);
  void wait_for_camera();
  void end(bool well, const std::string& reason);

  SourceConfig config_;
  std::string damage_;                     ///< what is wrong with a .oni file; empty: nothing
  std::unique_ptr<OpenNi2Device> device_;  ///< null while the camera is disconnected
  std::optional<CameraReturn> return_;     ///< while it is disconnected
  std::optional<FrameConverter> converter_;
  DeviceClock clock_;
  ColorClock color_clock_;
  FramePairer pairer_;
  UnreadCount unread_;
  std::optional<std::int64_t> device_index_;    ///< of the last depth image, since it was opened
  std::optional<std::int64_t> frame_index_;     ///< the same, continued over interruptions
  std::optional<std::int64_t> first_stamp_us_;  ///< since it was opened
  bool exposure_locked_ = false;
  bool looks_for_depth_ = true;  ///< no image had any so far, and that was not said
  PatientClock patience_;
  double last_depth_s_;       ///< of patience_
  std::string last_refusal_;  ///< why the last bad image was refused
  SourceStatus status_;
};

}  // namespace kintsugi::mapper
