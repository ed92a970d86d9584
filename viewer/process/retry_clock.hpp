#pragma once

#include <optional>

namespace kintsugi::viewer {

/// When to try again what has failed, and when that has been tried long enough. Times `now_s` are
/// those of a PatientClock.
class RetryClock {
 public:
  bool is_time(double now_s) const { return now_s >= next_s_; }

  /// What was tried has failed; counts only when it was time for it.
  void note_failure(double now_s) {
    if (!is_time(now_s)) return;
    next_s_ = now_s + kPause_s;
    if (!failing_since_s_) failing_since_s_ = now_s;
  }
  void note_success() { failing_since_s_.reset(); }

  bool is_failing() const { return failing_since_s_.has_value(); }
  bool has_tried_enough(double now_s) const {
    return failing_since_s_ && now_s - *failing_since_s_ >= kPatience_s;
  }

 private:
  static constexpr double kPause_s = 2.0;
  static constexpr double kPatience_s = 30.0;  ///< trying longer keeps nobody from finishing

  std::optional<double> failing_since_s_;
  double next_s_ = 0.0;
};

}  // namespace kintsugi::viewer
