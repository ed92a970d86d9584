#pragma once
// Between the thread that receives slices and the one that segments them.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Slices in order of arrival. It has no bound: a slice is never dropped, however far behind the
/// segmenter is. Safe for any number of threads.
class SliceQueue {
 public:
  void push(CloudSlice slice) {
    {
      const std::lock_guard lock(mutex_);
      slices_.push_back(std::move(slice));
    }
    changed_.notify_all();
  }

  /// Nothing will be pushed any more.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

  /// Takes everything there is; waits for it up to `timeout`, or until the queue is closed.
  std::vector<CloudSlice> take(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return closed_ || !slices_.empty(); });
    return std::exchange(slices_, {});
  }

  [[nodiscard]] std::int64_t size() const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::int64_t>(slices_.size());
  }

  /// Closed, and everything taken.
  [[nodiscard]] bool is_exhausted() const {
    const std::lock_guard lock(mutex_);
    return closed_ && slices_.empty();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<CloudSlice> slices_;
  bool closed_ = false;
};

}  // namespace kintsugi::segmenter
