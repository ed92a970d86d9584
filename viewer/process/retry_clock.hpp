#pragma once

#include <optional>

namespace kintsugi::viewer {

/// Decides when to retry a failed action, and when it has failed for so long that the process no
/// longer waits for it. Times `now_s` are those of a PatientClock.
class RetryClock {
 public:
  bool is_time(double now_s) const { return now_s >= next_s_; }

  /// Records a failed attempt; ignored when it was not time for one.
  void note_failure(double now_s) {
    if (!is_time(now_s)) return;
    next_s_ = now_s + kPause_s;
    if (!failing_since_s_) failing_since_s_ = now_s;
  }
  void note_success() { failing_since_s_.reset(); }

  bool is_failing() const { return failing_since_s_.has_value(); }
  /// Attempts have failed for kGiveUp_s.
  bool has_given_up(double now_s) const {
    return failing_since_s_ && now_s - *failing_since_s_ >= kGiveUp_s;
  }

 private:
  static constexpr double kPause_s = 2.0;
  static constexpr double kGiveUp_s = 30.0;

  std::optional<double> failing_since_s_;
  double next_s_ = 0.0;
};

}  // namespace kintsugi::viewer
