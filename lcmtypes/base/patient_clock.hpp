#pragma once
// Time that does not pass while the process is stopped.

#include <algorithm>
#include <chrono>
#include <functional>
#include <mutex>
#include <utility>

namespace kintsugi {

/// Steady time in which each reading adds at most kMaxStep_s: a process that was stopped (SIGSTOP,
/// a suspended machine, a debugger) finds that hardly any time has passed. What gives up after a
/// time uses it, because what it waits for could not be received either.
///
/// Read it more often than every kMaxStep_s, or it runs late. Any thread may read it.
class PatientClock {
 public:
  static constexpr double kMaxStep_s = 0.5;

  /// `steady_s` gives seconds that never decrease.
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
