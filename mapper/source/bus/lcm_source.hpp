#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/messages.hpp"
#include "mapper/source/frames/frame_source.hpp"
#include "mapper/source/frames/source_config.hpp"

namespace kintsugi::mapper {

class RgbdFrameDecoder;

inline constexpr std::string_view kLcmScheme = "lcm://";

/// Frames from RGBD_FRAME messages on a bus (`lcm://CHANNEL`). The sender is a mapper with
/// --publish-frames, another driver, or lcm-logplayer.
///
/// Only frames of the session heard first are read; others are counted as bad, and when no frame
/// but these comes for SourceConfig::lcm_silence_s, the source ends. With
/// SourceConfig::replay frames wait in memory, compressed, until next() is called; otherwise only
/// the newest waits, and the frames that it replaces are counted as dropped.
class LcmSource : public FrameSource {
 public:
  /// @throws std::invalid_argument without a channel, std::runtime_error when the bus cannot be
  ///   opened or the calibration file is bad
  explicit LcmSource(const SourceConfig& config);
  ~LcmSource() override;
  LcmSource(const LcmSource&) = delete;
  LcmSource& operator=(const LcmSource&) = delete;

  std::optional<RgbdFrame> next() override;
  [[nodiscard]] SourceStatus status() const override;

 private:
  struct Receiver;

  std::optional<RgbdFrameMessage> wait_for_message(PatientClock& patience);
  std::optional<RgbdFrame> convert(const RgbdFrameMessage& message);
  void end(bool well, const std::string& reason);

  SourceConfig config_;
  std::unique_ptr<RgbdFrameDecoder> decoder_;
  std::unique_ptr<Receiver> receiver_;
  std::int64_t session_ = 0;
  std::int64_t last_utime_ = -1;
  SourceStatus status_;
};

}  // namespace kintsugi::mapper
