#include "mapper/core/tracking/restart_rule.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kintsugi::mapper {

RestartRule::RestartRule(double restart_after_s)
    : restart_after_us_(std::llround(1e6 * restart_after_s)) {}

bool RestartRule::is_due(std::int64_t utime, TrackingState state) {
  const std::int64_t step_us = utime - std::exchange(last_utime_, utime);
  if (restart_after_us_ == 0 || state != TrackingState::kLost) {
    count_anew();
    return false;
  }
  lost_us_ = lost_us_ < 0 ? 0 : lost_us_ + std::min(step_us, kLongestStep_us);
  return lost_us_ >= restart_after_us_;
}

}  // namespace kintsugi::mapper
