#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "lcmtypes/messages.hpp"
#include "mapper/source/frame_source.hpp"

namespace kintsugi::mapper {

class RgbdFrameDecoder;

inline constexpr std::string_view kLcmScheme = "lcm://";

/// Frames from RGBD_FRAME messages on a bus (`lcm://CHANNEL`): from a mapper that publishes what it
/// reads, from another driver, or from a log through lcm-logplayer.
///
/// The first session heard is the one that is read. With `replay` frames wait in memory,
/// compressed, until they are asked for; otherwise only the newest waits, and what it replaces is
/// counted.
class LcmSource : public FrameSource {
 public:
  /// @throws std::invalid_argument without a channel, std::runtime_error when the bus cannot be
  /// opened or the calibration file is bad.
  explicit LcmSource(const SourceConfig& config);
  ~LcmSource() override;
  LcmSource(const LcmSource&) = delete;
  LcmSource& operator=(const LcmSource&) = delete;

  std::optional<RgbdFrame> next() override;
  [[nodiscard]] std::int64_t frames_total() const override { return -1; }
  [[nodiscard]] std::string name() const override { return config_.device; }
  [[nodiscard]] SourceCounts counts() const override;
  [[nodiscard]] std::string end_reason() const override { return end_reason_; }
  [[nodiscard]] bool ended_well() const override { return ended_well_; }

 private:
  struct Receiver;

  std::optional<RgbdFrameMessage> wait_for_message();
  std::optional<RgbdFrame> convert(const RgbdFrameMessage& message);
  void end(bool well, const std::string& reason);

  SourceConfig config_;
  std::unique_ptr<RgbdFrameDecoder> decoder_;
  std::unique_ptr<Receiver> receiver_;
  std::int64_t session_ = 0;
  std::int64_t last_utime_ = -1;
  SourceCounts counts_;
  std::string end_reason_;
  bool ended_well_ = true;
};

}  // namespace kintsugi::mapper
