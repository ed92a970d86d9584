#include "mapper/process/frame_reader.hpp"

#include <utility>

#include "lcmtypes/base/stopwatch.hpp"
#include "mapper/source/open_source.hpp"

namespace kintsugi::mapper {

FrameReader::FrameReader(SourceConfig config, const Attach& attach, std::size_t max_waiting)
    : max_waiting_(max_waiting) {
  config.stop_requested = [this, outer = std::move(config.stop_requested)] {
    return stop_ || outer();
  };
  config.notify = [this, outer = std::move(config.notify)](const SourceNotice& notice) {
    if (notice.kind == SourceNotice::Kind::kInterrupted) interrupted_ = true;
    if (notice.kind == SourceNotice::Kind::kResumed) interrupted_ = false;
    outer(notice);
  };
  source_ = open_frame_source(config);
  if (attach) source_ = attach(std::move(source_));
  status_ = source_->status();
  thread_ = std::thread([this] { run(); });
}

FrameReader::FrameReader(std::unique_ptr<FrameSource> source, std::size_t max_waiting)
    : max_waiting_(max_waiting),
      source_(std::move(source)),
      status_(source_->status()),
      thread_([this] { run(); }) {}

FrameReader::~FrameReader() {
  stop_ = true;
  changed_.notify_all();
  thread_.join();
}

std::optional<TimedFrame> FrameReader::next(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout, [this] { return !frames_.empty() || ended_; });
  if (frames_.empty()) return std::nullopt;
  TimedFrame frame = std::move(frames_.front());
  frames_.pop_front();
  frame.num_waiting = frames_.size();
  changed_.notify_all();
  return frame;
}

bool FrameReader::finished() const {
  const std::scoped_lock lock(mutex_);
  return ended_ && frames_.empty();
}

void FrameReader::rethrow_failure() const {
  const std::scoped_lock lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

SourceStatus FrameReader::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

std::optional<TimedFrame> FrameReader::read() {
  const Stopwatch stopwatch;
  const double cpu_before_ms = thread_cpu_ms();
  auto frame = source_->next();
  if (!frame) return std::nullopt;
  return TimedFrame{std::move(*frame), stopwatch.elapsed_ms(), thread_cpu_ms() - cpu_before_ms};
}

void FrameReader::run() {
  while (true) {
    std::optional<TimedFrame> frame;
    std::exception_ptr failure;
    try {
      frame = read();
    } catch (...) {
      failure = std::current_exception();
    }
    std::unique_lock lock(mutex_);
    status_ = source_->status();
    if (!frame) {
      ended_ = true;
      if (failure) status_.ended_well = false;
      failure_ = failure;
      changed_.notify_all();
      return;
    }
    frames_.push_back(*std::move(frame));
    changed_.notify_all();
    // stop_ is set without the lock, so its notification may come before this wait begins.
    while (frames_.size() >= max_waiting_ && !stop_) {
      changed_.wait_for(lock, std::chrono::milliseconds(100));
    }
    if (stop_) return;
  }
}

}  // namespace kintsugi::mapper
