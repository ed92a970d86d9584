#pragma once
// How much of the processor a process may use.

#include <algorithm>
#include <chrono>
#include <ctime>
#include <deque>

namespace kintsugi::segmenter {

/// A share of one core on average, from the beginning on. What is not used can be used later, up to
/// kSaved_s: a burst. What is used beyond, because the map has to be followed, is paid back, but no
/// more than kSaved_s: who joins a large map late would examine nothing for minutes.
class CpuBudget {
 public:
  using Clock = std::chrono::steady_clock;
  /// Of processor time: what a camera shows in some seconds of walking is examined at once.
  static constexpr double kSaved_s = 1.0;
  /// Nothing is begun with less: to examine one segment takes some hundredths of a second, seldom
  /// more than this, and must not go beyond the share.
  static constexpr double kReserve_s = 0.1;

  /// @param share of one core, > 0
  explicit CpuBudget(double share) : share_(share) {}

  /// There is enough left to begin something.
  bool has_some() {
    const Clock::time_point now = Clock::now();
    const double used_s = cpu_s() - last_cpu_s_;
    const double elapsed_s = std::chrono::duration<double>(now - last_time_).count();
    last_time_ = now;
    last_cpu_s_ += used_s;
    return has_some_after(elapsed_s, used_s);
  }
  /// The same when so much time has passed since, of which so much was used.
  bool has_some_after(double elapsed_s, double used_s) {
    saved_s_ = std::clamp(saved_s_ + share_ * elapsed_s - used_s, -kSaved_s, kSaved_s);
    return saved_s_ > kReserve_s;
  }

  /// Processor time of this process so far, seconds.
  static double cpu_s() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

 private:
  double share_;
  Clock::time_point last_time_ = Clock::now();
  double last_cpu_s_ = cpu_s();
  double saved_s_ = 0.0;
};

/// The share of one core that was used in the last minute.
class CpuShare {
 public:
  double now() {
    const auto time = CpuBudget::Clock::now();
    used_.push_back({time, CpuBudget::cpu_s()});
    while (used_.size() > 2 && time - used_.front().time > std::chrono::minutes(1)) {
      used_.pop_front();
    }
    const double elapsed_s = std::chrono::duration<double>(time - used_.front().time).count();
    return elapsed_s > 0.0 ? (used_.back().cpu_s - used_.front().cpu_s) / elapsed_s : 0.0;
  }

 private:
  struct Used {
    CpuBudget::Clock::time_point time;
    double cpu_s;
  };
  std::deque<Used> used_;
};

}  // namespace kintsugi::segmenter
