#pragma once

#include <array>

#include "lcmtypes/base/stopwatch.hpp"

namespace kintsugi::mapper {

/// Time of the stages of one frame, milliseconds; wall or CPU time.
struct StageTimes {
  double prepare_ms = 0.0;    ///< surface pyramid of the measured depth
  double track_ms = 0.0;      ///< registration, and relocalisation after a loss
  double shift_ms = 0.0;      ///< shift of the cube; queues slices for extraction
  double integrate_ms = 0.0;  ///< allocation and fusion
  double raycast_ms = 0.0;    ///< raycast of the model for the next frame
  double loops_ms = 0.0;      ///< waits for a correction that is due
  double patches_ms = 0.0;    ///< decides which patches are due, and copies their blocks

  StageTimes& operator+=(const StageTimes& other);
  double total_ms() const;
};

/// A stage, and its column name in tables.
struct Stage {
  const char* name;
  double StageTimes::*ms;
};

/// In the order in which a frame goes through them.
inline constexpr std::array kStages = {
    Stage{"prepare_ms", &StageTimes::prepare_ms}, Stage{"track_ms", &StageTimes::track_ms},
    Stage{"shift_ms", &StageTimes::shift_ms},     Stage{"integrate_ms", &StageTimes::integrate_ms},
    Stage{"raycast_ms", &StageTimes::raycast_ms}, Stage{"loops_ms", &StageTimes::loops_ms},
    Stage{"patches_ms", &StageTimes::patches_ms}};

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
  /// Ends a stage, which began at the end of the stage before or when this clock was made.
  void end_of(double StageTimes::*stage) {
    wall_.*stage += stopwatch_.lap_ms();
    const double cpu_ms = process_cpu_ms();
    cpu_.*stage += cpu_ms - cpu_at_lap_ms_;
    cpu_at_lap_ms_ = cpu_ms;
  }
  const StageTimes& wall() const { return wall_; }
  /// Of all threads of the process, including those that do other work at the time.
  const StageTimes& cpu() const { return cpu_; }

 private:
  Stopwatch stopwatch_;
  double cpu_at_lap_ms_ = process_cpu_ms();
  StageTimes wall_;
  StageTimes cpu_;
};

}  // namespace kintsugi::mapper
