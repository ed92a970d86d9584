#include "mapper/source/frames/paced_source.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace kintsugi::mapper {
namespace {

/// So late a thread may come on a busy machine. Drivers of cameras keep a few images for it.
constexpr std::chrono::milliseconds kTolerance(100);

}  // namespace

PacedSource::PacedSource(std::unique_ptr<FrameSource> recording, std::int64_t free_until_utime,
                         std::function<bool()> stop_requested)
    : recording_(std::move(recording)),
      free_until_utime_(free_until_utime),
      stop_requested_(std::move(stop_requested)) {}

std::optional<RgbdFrame> PacedSource::next() {
  auto frame = next_frame_ ? std::exchange(next_frame_, std::nullopt) : read();
  if (!frame || frame->utime <= free_until_utime_) return frame;
  wait_until(due(*frame));
  // This frame is overdue if the next one has been due for long, too.
  while ((next_frame_ = read()) && due(*next_frame_) + kTolerance <= Clock::now()) {
    frame = std::exchange(next_frame_, std::nullopt);
    ++num_dropped_;
  }
  return frame;
}

/// The time that reading takes delays the recording, so slow reading drops no frames.
std::optional<RgbdFrame> PacedSource::read() {
  const auto begin = Clock::now();
  auto frame = recording_->next();
  if (!frame || !start_) return frame;
  const auto now = Clock::now();
  const auto late_by = now - due(*frame);
  if (late_by > Clock::duration::zero()) *start_ += std::min(now - begin, late_by);
  return frame;
}

SourceStatus PacedSource::status() const {
  SourceStatus status = recording_->status();
  status.counts.frames_delivered -= num_dropped_ + (next_frame_ ? 1 : 0);
  status.counts.frames_dropped += num_dropped_;
  return status;
}

/// The first frame that is paced is due at once.
PacedSource::Clock::time_point PacedSource::due(const RgbdFrame& frame) {
  const std::chrono::microseconds utime(frame.utime);
  if (!start_) start_ = Clock::now().time_since_epoch() - utime;
  return Clock::time_point(*start_ + utime);
}

void PacedSource::wait_until(Clock::time_point due) const {
  constexpr std::chrono::milliseconds kPoll(50);
  while (!stop_requested_() && Clock::now() < due) {
    std::this_thread::sleep_until(std::min(due, Clock::now() + kPoll));
  }
}

}  // namespace kintsugi::mapper
