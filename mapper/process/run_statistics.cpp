#include "mapper/process/run_statistics.hpp"

#include <algorithm>
#include <cmath>

#include "lcmtypes/base/process_memory.hpp"
#include "mapper/process/state_text.hpp"

namespace kintsugi::mapper {
namespace {

/// The smallest value that at least this share of all do not exceed; 0 of none.
double quantile(const std::vector<double>& ascending, double share) {
  if (ascending.empty()) return 0.0;
  const double rank = std::ceil(share * static_cast<double>(ascending.size()));
  return ascending[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
}

}  // namespace

void RunStatistics::begin_part() {
  parts_.emplace_back();
  state_ = TrackingState::kStarting;  // the end of the loss is not a relocalisation
}

void RunStatistics::add(const TrackingResult& tracking, bool is_fused,
                        const FrameTimings& timings) {
  if (state_ == TrackingState::kLost && tracking.state == TrackingState::kTracking) {
    ++frames_relocalised_;
  }
  state_ = tracking.state;
  loss_reason_ = reason_text(tracking);
  undetermined_ = tracking.quality.undetermined;
  ++frames_;
  ++parts_.back().frames;
  if (is_located(state_)) {
    ++frames_tracked_;
    ++parts_.back().frames_tracked;
    if (!is_fused) ++frames_tracked_only_;
  }
  if (state_ == TrackingState::kLost) ++frames_lost_;
  frame_ms_ += timings.frame_ms;
  cpu_ms_ += timings.cpu_ms;
  sums_ += timings;
  frame_times_ms_.push_back(timings.frame_ms);
}

double RunStatistics::mean_over_run(double total) const {
  return frames_ > 0 ? total / static_cast<double>(frames_) : 0.0;
}

void RunStatistics::report(MapperStatus& status) {
  const double elapsed_s = 1e-3 * report_clock_.lap_ms();
  const auto frames = static_cast<double>(frame_times_ms_.size());
  const auto mean = [frames](double sum) { return frames > 0.0 ? sum / frames : 0.0; };
  status.state = state_;
  status.loss_reason = loss_reason_;
  status.undetermined = undetermined_;
  status.frames_read = frames_;
  status.frames_tracked = frames_tracked_;
  status.frames_lost = frames_lost_;
  status.frames_relocalised = frames_relocalised_;
  status.memory_bytes = process_memory().resident_bytes;
  status.frame_rate_hz = elapsed_s > 0.0 ? frames / elapsed_s : 0.0;
  std::sort(frame_times_ms_.begin(), frame_times_ms_.end());
  status.frame_p50_ms = quantile(frame_times_ms_, 0.50);
  status.frame_p99_ms = quantile(frame_times_ms_, 0.99);
  status.cpu_ms = mean(sums_.cpu_ms);
  status.read_ms = mean(sums_.read_ms);
  status.convert_ms = mean(sums_.convert_ms);
  status.prepare_ms = mean(sums_.stages.prepare_ms);
  status.track_ms = mean(sums_.stages.track_ms);
  status.shift_ms = mean(sums_.stages.shift_ms);
  status.integrate_ms = mean(sums_.stages.integrate_ms);
  status.raycast_ms = mean(sums_.stages.raycast_ms);
  status.extract_ms = mean(sums_.extract_ms);
  status.publish_ms = mean(sums_.publish_ms);
  sums_ = {};
  frame_times_ms_.clear();
}

}  // namespace kintsugi::mapper
