#include "mapper/source/frames/paced_source.hpp"

#include <algorithm>
#include <thread>
#include <utility>

namespace kintsugi::mapper {
namespace {

/// So late a thread may come on a busy machine. Drivers of cameras keep a few images for it.
constexpr std::chrono::milliseconds kTolerance(100);
/// A camera that sends nothing for longer counts as disconnected. A clock that was set while a
/// recording was made leaves gaps of years.
constexpr std::chrono::seconds kLongestPause(5);

}  // namespace

PacedSource::PacedSource(std::unique_ptr<FrameSource> recording, std::int64_t free_until_utime,
                         std::function<bool()> stop_requested,
                         std::function<void(const SourceNotice&)> notify)
    : recording_(std::move(recording)),
      free_until_utime_(free_until_utime),
      stop_requested_(std::move(stop_requested)),
      notify_(std::move(notify)) {}

std::optional<RgbdFrame> PacedSource::next() {
  auto frame = next_frame_ ? std::exchange(next_frame_, std::nullopt) : read();
  if (!frame || frame->utime <= free_until_utime_) return frame;
  shorten_pause(*frame);
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

void PacedSource::shorten_pause(const RgbdFrame& frame) {
  const auto pause = due(frame) - Clock::now();
  if (pause <= kLongestPause) return;
  *start_ -= pause;
  notify_({SourceNotice::Kind::kInformation,
           "nothing was recorded for " +
               std::to_string(std::chrono::duration_cast<std::chrono::seconds>(pause).count()) +
               " s before frame " + std::to_string(frame.frame_index) + ": not waited for"});
}

void PacedSource::wait_until(Clock::time_point due) const {
  constexpr std::chrono::milliseconds kPoll(50);
  while (!stop_requested_() && Clock::now() < due) {
    std::this_thread::sleep_until(std::min(due, Clock::now() + kPoll));
  }
}

}  // namespace kintsugi::mapper
