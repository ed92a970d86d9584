#pragma once
// The queue between the thread that receives slices and the one that segments them.

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "lcmtypes/stream/stream_session.hpp"
#include "segmenter/map/slice_sequencer.hpp"

namespace kintsugi::segmenter {

/// Slices in order of arrival. Counts the memory of all slices that were received and are not
/// segmented. push() never refuses a slice: the receiver checks room() first. Safe for any number
/// of threads.
class SliceQueue {
 public:
  /// @param max_bytes of slices in the queue and of those that were taken and are not segmented
  explicit SliceQueue(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  void push(CloudSlice slice) {
    {
      const std::lock_guard lock(mutex_);
      queued_bytes_ += bytes_of(slice);
      slices_.push_back(std::move(slice));
    }
    changed_.notify_all();
  }

  /// No more slices will be pushed.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

  /// Ends the wait of take(), or its next one.
  void wake() {
    {
      const std::lock_guard lock(mutex_);
      is_woken_ = true;
    }
    changed_.notify_all();
  }

  /// Takes all slices; when there are none, waits up to `timeout` or until the queue is closed or
  /// wake() is called.
  /// What is taken counts as waiting to be segmented from now on.
  std::vector<CloudSlice> take(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return closed_ || is_woken_ || !slices_.empty(); });
    is_woken_ = false;
    waiting_bytes_ += std::exchange(queued_bytes_, 0);
    return std::exchange(slices_, {});
  }

  /// Sets how much of what was taken still waits to be segmented, whether it waits for a missing
  /// slice, and whether it waits for the end of a batch.
  void set_waiting(std::size_t bytes, bool is_for_missing, bool is_for_batch = false) {
    {
      const std::lock_guard lock(mutex_);
      waiting_bytes_ = bytes;
      waits_for_missing_ = is_for_missing;
      waits_for_batch_ = is_for_batch;
    }
    changed_.notify_all();
  }

  /// Nothing when the queue is full; but a missing slice is accepted all the same when segmentation
  /// cannot continue without it.
  StreamRoom room() const {
    const std::lock_guard lock(mutex_);
    if (!is_full()) {
      return StreamRoom::kPlenty;
    }
    return waits_for_missing_ && slices_.empty() ? StreamRoom::kOnlyNext : StreamRoom::kNone;
  }

  /// For the reader of a log: waits up to `timeout` until the next slice is to be read. That is so
  /// also when the queue is full of a batch whose end is still to be read: the memory is bounded by
  /// a batch then.
  bool wait_for_room(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(
        lock, timeout, [this] { return !is_full() || (waits_for_batch_ && slices_.empty()); });
  }

  std::int64_t size() const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::int64_t>(slices_.size());
  }

  /// Of slices that were received and are not segmented.
  std::size_t bytes() const {
    const std::lock_guard lock(mutex_);
    return queued_bytes_ + waiting_bytes_;
  }

  /// True when the queue is closed and empty.
  bool is_exhausted() const {
    const std::lock_guard lock(mutex_);
    return closed_ && slices_.empty();
  }

 private:
  bool is_full() const { return queued_bytes_ + waiting_bytes_ >= max_bytes_; }

  const std::size_t max_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<CloudSlice> slices_;
  std::size_t queued_bytes_ = 0;   // in slices_
  std::size_t waiting_bytes_ = 0;  // taken, and not segmented
  bool waits_for_missing_ = false;
  bool waits_for_batch_ = false;
  bool closed_ = false;
  bool is_woken_ = false;
};

}  // namespace kintsugi::segmenter
