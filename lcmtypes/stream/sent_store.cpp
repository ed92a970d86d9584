#include "lcmtypes/stream/sent_store.hpp"

#include <stdexcept>
#include <string>

namespace kintsugi {

void RecentChunks::set_max_bytes(std::size_t max_bytes) {
  const std::lock_guard lock(mutex_);
  max_bytes_ = max_bytes;
}

void RecentChunks::add(std::int64_t sequence, ByteView message) {
  Bytes chunk(message.begin(), message.end());
  const std::lock_guard lock(mutex_);
  if (!chunks_.empty() && sequence != next_sequence_) {
    throw std::invalid_argument("RecentChunks: sequence is " + std::to_string(sequence) +
                                ", expected " + std::to_string(next_sequence_));
  }
  bytes_ += chunk.size();
  chunks_.push_back(std::move(chunk));
  next_sequence_ = sequence + 1;
  while (bytes_ > max_bytes_ && chunks_.size() > 1) {
    bytes_ -= chunks_.front().size();
    chunks_.pop_front();
  }
}

std::optional<Bytes> RecentChunks::find(std::int64_t sequence) const {
  const std::lock_guard lock(mutex_);
  const std::int64_t age = next_sequence_ - sequence;  // 1: the newest
  if (age < 1 || age > static_cast<std::int64_t>(chunks_.size())) return std::nullopt;
  return chunks_[chunks_.size() - static_cast<std::size_t>(age)];
}

std::int64_t RecentChunks::first_sequence() const {
  const std::lock_guard lock(mutex_);
  return next_sequence_ - static_cast<std::int64_t>(chunks_.size());
}

std::int64_t RecentChunks::next_sequence() const {
  const std::lock_guard lock(mutex_);
  return next_sequence_;
}

std::size_t RecentChunks::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace kintsugi
