#pragma once

#include <cstdint>

#include "lcmtypes/tracking_state.hpp"

namespace kintsugi::mapper {

/// Decides when a camera that stays lost begins another part of the map.
///
/// Time is that of the frames, so that the same frames always begin the same parts. Between two
/// lost frames at most kLongestStep_us count: in a longer gap the camera was disconnected, and not
/// lost as far as anybody knows.
class RestartRule {
 public:
  static constexpr std::int64_t kLongestStep_us = 1'000'000;  ///< no camera is as slow as that

  /// @param restart_after_s how long the camera must be lost; 0: another part never begins
  explicit RestartRule(double restart_after_s);

  /// To be called with each frame. True when the camera has been lost for so long: this frame may
  /// begin another part.
  bool is_due(std::int64_t utime, TrackingState state);

  /// A part has begun: the time counts anew.
  void count_anew() { lost_us_ = -1; }

 private:
  const std::int64_t restart_after_us_;
  std::int64_t lost_us_ = -1;  ///< since the first lost frame; -1: the last frame was not lost
  std::int64_t last_utime_ = 0;
};

}  // namespace kintsugi::mapper
