#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "mapper/source/frame_source.hpp"

namespace kintsugi::mapper {

/// A recording at its own speed: a frame comes when its time has come, and like a camera the
/// recording does not wait for who is late. Whole frames are dropped, so that those which are not
/// are the same as without any haste.
class PacedSource : public FrameSource {
 public:
  /// @param recording gives every frame as fast as it is asked
  /// @param free_until_utime frames up to this time come without pacing; -1: none does
  PacedSource(std::unique_ptr<FrameSource> recording, std::int64_t free_until_utime,
              std::function<bool()> stop_requested);

  std::optional<RgbdFrame> next() override;
  [[nodiscard]] std::int64_t frames_total() const override { return recording_->frames_total(); }
  [[nodiscard]] std::string name() const override { return recording_->name(); }
  [[nodiscard]] SourceCounts counts() const override;
  [[nodiscard]] std::string end_reason() const override { return recording_->end_reason(); }
  [[nodiscard]] bool ended_well() const override { return recording_->ended_well(); }

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<RgbdFrame> read();
  Clock::time_point due(const RgbdFrame& frame);
  void wait_until(Clock::time_point due) const;

  std::unique_ptr<FrameSource> recording_;
  const std::int64_t free_until_utime_;
  const std::function<bool()> stop_requested_;
  std::optional<Clock::duration> start_;  ///< when the recording's time 0 was
  std::optional<RgbdFrame> next_frame_;   ///< read, and not due before
  std::int64_t num_dropped_ = 0;
};

}  // namespace kintsugi::mapper
