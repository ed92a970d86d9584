#include "segmenter/output/background_writer.hpp"

#include <algorithm>
#include <utility>

namespace kintsugi::segmenter {

BackgroundWriter::BackgroundWriter() : thread_([this] { run(); }) {}

BackgroundWriter::~BackgroundWriter() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackgroundWriter::put(const std::string& name, Job job) {
  {
    const std::lock_guard lock(mutex_);
    const auto waiting = std::ranges::find(jobs_, name, &NamedJob::name);
    if (waiting != jobs_.end()) {
      std::swap(waiting->job, job);  // the old job is freed after the lock is released
    } else {
      jobs_.push_back({name, std::move(job)});
    }
  }
  changed_.notify_all();
}

void BackgroundWriter::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty() && !is_busy_; });
}

void BackgroundWriter::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return is_ending_ || !jobs_.empty(); });
    if (jobs_.empty()) {
      return;
    }
    Job job = std::move(jobs_.front().job);
    jobs_.pop_front();
    is_busy_ = true;
    lock.unlock();
    job();
    job = nullptr;
    lock.lock();
    is_busy_ = false;
    changed_.notify_all();
  }
}

}  // namespace kintsugi::segmenter
