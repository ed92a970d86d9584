#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "viewer/receiving/message.hpp"

namespace kintsugi::viewer {

/// Queue from the thread that receives messages to the one that draws. It fills while a picture is
/// drawn; when it has no room the receiver refuses slices and updates and requests them again
/// later.
class Inbox {
 public:
  explicit Inbox(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Adds a message. Without room, droppable messages are dropped; slices and updates are added all
  /// the same, because they are complete and would not be sent again.
  void put(Message message) {
    {
      const std::lock_guard lock(mutex_);
      if (bytes_ >= max_bytes_ && is_droppable(message)) return;
      bytes_ += bytes_of(message);
      messages_.push_back(std::move(message));
    }
    arrived_.notify_one();
  }

  /// Removes the oldest message; waits up to `timeout` for one.
  std::optional<Message> take(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    if (!arrived_.wait_for(lock, timeout, [this] { return !messages_.empty(); })) return {};
    std::optional<Message> message(std::move(messages_.front()));
    messages_.pop_front();
    bytes_ -= bytes_of(*message);
    return message;
  }

  bool has_room() const { return bytes() < max_bytes_; }
  bool is_empty() const { return bytes() == 0; }

  std::size_t bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
  }

 private:
  const std::size_t max_bytes_;
  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable arrived_;
  std::deque<Message> messages_;
  std::size_t bytes_ = 0;
};

}  // namespace kintsugi::viewer
