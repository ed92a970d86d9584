#include "mapper/process/run_statistics.hpp"

#include <algorithm>
#include <fstream>

#include <unistd.h>

namespace kintsugi::mapper {

void RunStatistics::add(const FrameResult& result, double publish_ms) {
  state_ = result.tracking.state;
  ++frames_;
  if (state_ == TrackingState::kTracking || state_ == TrackingState::kGiven) ++frames_tracked_;
  if (state_ == TrackingState::kLost) ++frames_lost_;
  total_ms_ += result.times.total_ms() + publish_ms;
  ++since_report_.frames;
  since_report_.times += result.times;
  since_report_.publish_ms += publish_ms;
}

double RunStatistics::mean_frame_ms() const {
  return frames_ > 0 ? total_ms_ / static_cast<double>(frames_) : 0.0;
}

void RunStatistics::report(MapperStatus& status, double read_ms, double extract_ms) {
  const double elapsed_s = 1e-3 * report_clock_.lap_ms();
  const Sums& sums = since_report_;
  const auto frames = static_cast<double>(std::max<std::int64_t>(1, sums.frames));
  status.state = state_;
  status.frames_read = frames_;
  status.frames_tracked = frames_tracked_;
  status.frames_lost = frames_lost_;
  status.memory_bytes = resident_memory_bytes();
  status.frame_rate_hz = elapsed_s > 0.0 ? static_cast<double>(sums.frames) / elapsed_s : 0.0;
  status.read_ms = (read_ms - sums.read_ms) / frames;
  status.track_ms = (sums.times.prepare_ms + sums.times.track_ms) / frames;
  status.integrate_ms = (sums.times.shift_ms + sums.times.integrate_ms) / frames;
  status.raycast_ms = sums.times.raycast_ms / frames;
  status.extract_ms = (extract_ms - sums.extract_ms) / frames;
  status.publish_ms = sums.publish_ms / frames;
  since_report_ = {};
  since_report_.read_ms = read_ms;
  since_report_.extract_ms = extract_ms;
}

std::int64_t resident_memory_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::int64_t total_pages = 0;
  std::int64_t resident_pages = 0;
  if (!(statm >> total_pages >> resident_pages)) return 0;
  return resident_pages * sysconf(_SC_PAGESIZE);
}

}  // namespace kintsugi::mapper
