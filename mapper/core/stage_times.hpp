#pragma once

#include <array>

#include "lcmtypes/base/stopwatch.hpp"

namespace kintsugi::mapper {

/// Time of the stages of one frame, milliseconds; wall or CPU.
struct StageTimes {
  double prepare_ms = 0.0;    ///< surfaces of the measured depth, at every size
  double track_ms = 0.0;      ///< registration
  double shift_ms = 0.0;      ///< the cube moves, what leaves it goes to the slice worker
  double integrate_ms = 0.0;  ///< allocation and fusion
  double raycast_ms = 0.0;    ///< the model for the next frame

  StageTimes& operator+=(const StageTimes& other);
  double total_ms() const;
};

/// A stage, as tables name it.
struct Stage {
  const char* name;
  double StageTimes::*ms;
};

/// In the order in which a frame goes through them.
inline constexpr std::array kStages = {
    Stage{"prepare_ms", &StageTimes::prepare_ms}, Stage{"track_ms", &StageTimes::track_ms},
    Stage{"shift_ms", &StageTimes::shift_ms}, Stage{"integrate_ms", &StageTimes::integrate_ms},
    Stage{"raycast_ms", &StageTimes::raycast_ms}};

inline StageTimes& StageTimes::operator+=(const StageTimes& other) {
  for (const Stage& stage : kStages) this->*stage.ms += other.*stage.ms;
  return *this;
}

inline double StageTimes::total_ms() const {
  double total = 0.0;
  for (const Stage& stage : kStages) total += this->*stage.ms;
  return total;
}

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
  Stopwatch stopwatch_;
  double cpu_at_lap_ms_ = process_cpu_ms();
  StageTimes wall_;
  StageTimes cpu_;
};

}  // namespace kintsugi::mapper
