#pragma once

#include <ctime>

#include "mapper/core/stopwatch.hpp"

namespace kintsugi::mapper {

/// Time of the stages of one frame, milliseconds; wall or CPU.
struct StageTimes {
  double prepare_ms = 0.0;    ///< surfaces of the measured depth, at every size
  double track_ms = 0.0;      ///< registration
  double shift_ms = 0.0;      ///< the cube moves, what leaves it goes to the slice worker
  double integrate_ms = 0.0;  ///< allocation and fusion
  double raycast_ms = 0.0;    ///< the model for the next frame

  StageTimes& operator+=(const StageTimes& other) {
    prepare_ms += other.prepare_ms;
    track_ms += other.track_ms;
    shift_ms += other.shift_ms;
    integrate_ms += other.integrate_ms;
    raycast_ms += other.raycast_ms;
    return *this;
  }
  double total_ms() const { return prepare_ms + track_ms + shift_ms + integrate_ms + raycast_ms; }
};

/// Times the stages of a frame as they end, one after another.
class StageClock {
 public:
  /// The stage that began with this clock or with the end of the last stage ends here.
  void end_of(double StageTimes::*stage) {
    wall_.*stage += stopwatch_.lap_ms();
    const double cpu_ms = process_cpu_ms();
    cpu_.*stage += cpu_ms - cpu_at_lap_ms_;
    cpu_at_lap_ms_ = cpu_ms;
  }
  const StageTimes& wall() const { return wall_; }
  /// Of all threads of the process, also of those that work on something else meanwhile.
  const StageTimes& cpu() const { return cpu_; }

 private:
  static double process_cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
  }

  Stopwatch stopwatch_;
  double cpu_at_lap_ms_ = process_cpu_ms();
  StageTimes wall_;
  StageTimes cpu_;
};

}  // namespace kintsugi::mapper
