#pragma once

#include <cstdint>
#include <string>

#include "lcmtypes/messages.hpp"
#include "mapper/core/mapper_pipeline.hpp"
#include "mapper/core/stopwatch.hpp"

namespace kintsugi::mapper {

/// Counts and mean times of a run, as MAPPER_STATUS shows them.
class RunStatistics {
 public:
  /// One mapped frame; `publish_ms` is the time its messages took.
  void add(const FrameResult& result, double publish_ms);

  std::int64_t frames() const { return frames_; }
  std::int64_t frames_tracked() const { return frames_tracked_; }
  std::int64_t frames_lost() const { return frames_lost_; }
  /// Mean over the run of all stages but reading, milliseconds.
  double mean_frame_ms() const;

  /// Fills state, frame counts, rates and stage times, these as means since the last call.
  /// `read_ms` and `extract_ms` are totals since the start of the run.
  void report(MapperStatus& status, double read_ms, double extract_ms);

 private:
  struct Sums {
    std::int64_t frames = 0;
    StageTimes times;
    double publish_ms = 0.0;
    double read_ms = 0.0;     ///< at the last report
    double extract_ms = 0.0;  ///< at the last report
  };

  std::int64_t frames_ = 0;
  std::int64_t frames_tracked_ = 0;
  std::int64_t frames_lost_ = 0;
  double total_ms_ = 0.0;
  TrackingState state_ = TrackingState::kStarting;
  Sums since_report_;
  Stopwatch report_clock_;
};

/// Resident memory of this process, bytes, from /proc/self/statm; 0 where there is none.
std::int64_t resident_memory_bytes();

}  // namespace kintsugi::mapper
