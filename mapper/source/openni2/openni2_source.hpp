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

namespace kintsugi::mapper {

/// Frames from OpenNI2: a camera, a .oni file, or one of our own devices.
///
/// A camera that goes away is waited for, and the frames go on when it is back. A .oni file that is
/// cut off is read as far as it goes (from a mended copy in the folder for temporary files, which
/// lasts only while it is being opened).
class OpenNi2Source : public FrameSource {
 public:
  /// @throws std::runtime_error naming the device or file and what is wrong with it or with its
  /// calibration.
  explicit OpenNi2Source(const SourceConfig& config);

  std::optional<RgbdFrame> next() override;
  [[nodiscard]] SourceStatus status() const override;

 private:
  using Clock = std::chrono::steady_clock;

  void read_image();
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
  std::string damage_;                     ///< of a .oni file; empty: none
  std::unique_ptr<OpenNi2Device> device_;  ///< null while the camera is away
  std::optional<CameraReturn> return_;     ///< while it is away
  std::optional<FrameConverter> converter_;
  DeviceClock clock_;
  ColorClock color_clock_;
  FramePairer pairer_;
  std::optional<std::int64_t> device_index_;    ///< of the last depth image, since it was opened
  std::optional<std::int64_t> frame_index_;     ///< ... in our count
  std::optional<std::int64_t> first_stamp_us_;  ///< since it was opened
  bool exposure_locked_ = false;
  PatientClock patience_;
  double last_depth_s_;       ///< of patience_
  std::string last_refusal_;  ///< why the last bad image was refused
  SourceStatus status_;
};

}  // namespace kintsugi::mapper
