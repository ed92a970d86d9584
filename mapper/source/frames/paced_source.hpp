#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "mapper/source/frames/frame_source.hpp"
#include "mapper/source/frames/source_config.hpp"

namespace kintsugi::mapper {

/// Plays a recording at the speed at which it was recorded. next() returns a frame when it is due;
/// like with a camera, frames that are long overdue are dropped when newer ones are due. Depth and
/// colour of a frame are dropped together, so the remaining frames are the same as without pacing.
class PacedSource : public FrameSource {
 public:
  /// @param recording gives every frame as fast as next() is called
  /// @param free_until_utime frames up to this time are not paced, microseconds; -1: all are
  /// @param notify is told of gaps in the recording that are not waited for
  PacedSource(
      std::unique_ptr<FrameSource> recording, std::int64_t free_until_utime,
      std::function<bool()> stop_requested,
      std::function<void(const SourceNotice&)> notify = [](const SourceNotice&) {});

  std::optional<RgbdFrame> next() override;
  [[nodiscard]] SourceStatus status() const override;

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<RgbdFrame> read();
  Clock::time_point due(const RgbdFrame& frame);
  void shorten_pause(const RgbdFrame& frame);
  void wait_until(Clock::time_point due) const;

  std::unique_ptr<FrameSource> recording_;
  const std::int64_t free_until_utime_;
  const std::function<bool()> stop_requested_;
  const std::function<void(const SourceNotice&)> notify_;
  std::optional<Clock::duration> start_;  ///< when time 0 of the recording was
  std::optional<RgbdFrame> next_frame_;   ///< read and not yet returned
  std::int64_t num_dropped_ = 0;
};

}  // namespace kintsugi::mapper
