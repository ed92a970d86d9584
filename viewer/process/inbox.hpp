#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "viewer/process/message.hpp"

namespace kintsugi::viewer {

/// What has been received and not yet used. It fills while a picture is drawn, up to a bound: then
/// there is no room, what receives takes no more, and asks for it again later.
class Inbox {
 public:
  explicit Inbox(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Takes the message even when there is no room, because it has been received; but poses,
  /// statuses and answers, which nobody waits for, are dropped then.
  void put(Message message) {
    {
      const std::lock_guard lock(mutex_);
      if (bytes_ >= max_bytes_ && is_passing(message)) return;
      bytes_ += bytes_of(message);
      messages_.push_back(std::move(message));
    }
    arrived_.notify_one();
  }

  /// The message that came first; waits up to `timeout` for one.
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
