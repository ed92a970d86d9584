#pragma once

#include <chrono>

namespace kintsugi::mapper {

/// Wall time since its construction or its last lap.
class Stopwatch {
 public:
  double elapsed_ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }

  /// Time since the last lap, which ends here.
  double lap_ms() {
    const double elapsed = elapsed_ms();
    start_ = Clock::now();
    return elapsed;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace kintsugi::mapper
