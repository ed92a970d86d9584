#pragma once
// A clock that stands still while the process is stopped.

#include <algorithm>
#include <chrono>
#include <functional>
#include <mutex>
#include <utility>

namespace kintsugi {

/// A steady clock in which each reading adds at most kMaxStep_s. For a process that was stopped
/// (SIGSTOP, a suspended machine, a debugger) hardly any time has passed. Timeouts of receivers use
/// it, because a stopped process cannot receive either.
///
/// It must be read more often than every kMaxStep_s, or it runs late. Any thread may read it.
class PatientClock {
 public:
  static constexpr double kMaxStep_s = 0.5;

  /// @param steady_s returns seconds that never decrease
  explicit PatientClock(std::function<double()> steady_s = steady_clock_s)
      : steady_s_(std::move(steady_s)), last_s_(steady_s_()) {}

  /// Seconds since construction.
  double now_s() {
    const std::lock_guard lock(mutex_);
    const double steady_s = steady_s_();
    now_s_ += std::min(steady_s - last_s_, kMaxStep_s);
    last_s_ = steady_s;
    return now_s_;
  }

  static double steady_clock_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }

 private:
  const std::function<double()> steady_s_;
  std::mutex mutex_;  // guards what follows
  double last_s_;
  double now_s_ = 0.0;
};

}  // namespace kintsugi
