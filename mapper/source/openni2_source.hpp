#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "mapper/source/frame_converter.hpp"
#include "mapper/source/frame_pairer.hpp"
#include "mapper/source/frame_source.hpp"
#include "mapper/source/openni2_device.hpp"

namespace kintsugi::mapper {

/// Frames from OpenNI2: a camera, a .oni file, or one of our own devices.
///
/// A .oni file that is cut off is read as far as it goes (from a mended copy in the folder for
/// temporary files, which lasts only while it is being opened).
class OpenNi2Source : public FrameSource {
 public:
  /// @throws std::runtime_error naming the device or file and what is wrong with it or with its
  /// calibration.
  explicit OpenNi2Source(const SourceConfig& config);

  std::optional<RgbdFrame> next() override;
  [[nodiscard]] std::int64_t frames_total() const override { return frames_total_; }
  [[nodiscard]] std::string name() const override { return device_->name(); }
  [[nodiscard]] SourceCounts counts() const override;
  [[nodiscard]] std::string end_reason() const override { return end_reason_; }
  [[nodiscard]] bool ended_well() const override { return ended_well_; }

 private:
  void read_image();
  void add(DeviceImage image);
  void check_for_end(OpenNi2Device::State state_before);
  void end(bool well, const std::string& reason);

  SourceConfig config_;
  std::string damage_;  ///< of a .oni file; empty: none
  std::unique_ptr<OpenNi2Device> device_;
  std::optional<FrameConverter> converter_;
  FramePairer pairer_;
  std::int64_t frames_total_ = -1;
  std::int64_t last_depth_index_ = 0;
  std::chrono::steady_clock::time_point last_image_;
  SourceCounts counts_;
  std::string end_reason_;
  bool ended_well_ = true;
};

}  // namespace kintsugi::mapper
