#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lcmtypes/base/stopwatch.hpp"
#include "lcmtypes/messages.hpp"
#include "mapper/core/tracking/tracker.hpp"
#include "mapper/process/frame_timings.hpp"

namespace kintsugi::mapper {

/// Counts and times of a run, as MAPPER_STATUS shows them.
class RunStatistics {
 public:
  struct Part {
    std::int64_t frames = 0;
    std::int64_t frames_tracked = 0;
  };

  /// The frames that follow are of another part, as far as is known.
  void begin_part();
  /// One mapped frame.
  void add(const TrackingResult& tracking, bool is_fused, const FrameTimings& timings);

  /// As they began; loops may have joined some.
  const std::vector<Part>& parts() const { return parts_; }
  std::int64_t frames() const { return frames_; }
  std::int64_t frames_tracked() const { return frames_tracked_; }
  /// Of these, those that were not fused.
  std::int64_t frames_tracked_only() const { return frames_tracked_only_; }
  std::int64_t frames_lost() const { return frames_lost_; }
  std::int64_t frames_relocalised() const { return frames_relocalised_; }
  /// Means over the run, milliseconds a frame.
  double mean_frame_ms() const { return mean_over_run(frame_ms_); }
  double mean_cpu_ms() const { return mean_over_run(cpu_ms_); }

  /// Fills state, frame counts, rate and times, these over the frames since the last call.
  void report(MapperStatus& status);

 private:
  double mean_over_run(double total) const;

  std::vector<Part> parts_{1};
  std::int64_t frames_ = 0;
  std::int64_t frames_tracked_ = 0;
  std::int64_t frames_tracked_only_ = 0;
  std::int64_t frames_lost_ = 0;
  std::int64_t frames_relocalised_ = 0;
  double frame_ms_ = 0.0;  ///< of the whole run
  double cpu_ms_ = 0.0;    ///< of the whole run
  TrackingState state_ = TrackingState::kStarting;
  std::string loss_reason_;
  int undetermined_ = 0;

  FrameTimings sums_;                   ///< since the last report
  std::vector<double> frame_times_ms_;  ///< since the last report
  Stopwatch report_clock_;
};

}  // namespace kintsugi::mapper
