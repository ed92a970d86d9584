#include "mapper/source/frames/device_clock.hpp"

#include <algorithm>
#include <cstdlib>

namespace kintsugi::mapper {
namespace {

constexpr std::int64_t kMaxStray_us = 1'000'000;

std::int64_t microseconds_between(DeviceClock::Instant begin, DeviceClock::Instant end) {
  return std::chrono::duration_cast<std::chrono::microseconds>(end - begin).count();
}

}  // namespace

std::int64_t DeviceClock::time_of(Stream stream, std::int64_t stamp_us, Instant arrival) {
  Line& line = lines_.at(static_cast<std::size_t>(stream));
  if (!goes_on(line, stamp_us, arrival)) {
    if (line.seen && line.epoch == epoch_) begin_epoch(line, stamp_us, arrival);
    line.epoch = epoch_;
    line.offset_us = offset_us_;
  }
  const std::int64_t time_us = stamp_us + line.offset_us;
  line.time_us = line.seen ? std::max(time_us, line.time_us + 1) : time_us;
  line.seen = true;
  line.interrupted = false;
  line.stamp_us = stamp_us;
  line.arrival = arrival;
  return line.time_us;
}

void DeviceClock::interrupt() {
  for (Line& line : lines_) line.interrupted = true;
}

bool DeviceClock::goes_on(const Line& line, std::int64_t stamp_us, Instant arrival) const {
  if (!line.seen) return false;
  const std::int64_t step_us = stamp_us - line.stamp_us;
  if (step_us < -period_us_) return false;
  if (!live_) return true;
  return std::abs(step_us - microseconds_between(line.arrival, arrival)) <= kMaxStray_us;
}

void DeviceClock::begin_epoch(const Line& line, std::int64_t stamp_us, Instant arrival) {
  // A replay does not depend on how fast it is read.
  const bool by_arrival = live_ || line.interrupted;
  const std::int64_t passed_us = by_arrival ? microseconds_between(line.arrival, arrival) : 0;
  offset_us_ = line.time_us + std::max(passed_us, period_us_) - stamp_us;
  ++epoch_;
}

}  // namespace kintsugi::mapper
