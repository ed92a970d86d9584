#pragma once
// The messages of one session of which some chunks have not been received yet.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi {

/// Collects chunks, in any order, until their message is complete. It needs memory only for the
/// chunks that it was given.
template <BulkMessage Message>
class MessageAssembler {
 public:
  using Chunks = std::vector<Chunk<Message>>;

  /// Memory of a chunk.
  static std::size_t bytes(const Chunk<Message>& chunk) {
    return sizeof(chunk) + chunk.part.size() + chunk.identity.size();
  }

  /// The sequence number of a chunk with another header that was added before and, by its numbers,
  /// belongs to the same message: one of the two is false. Nothing: there is none.
  std::optional<std::int64_t> conflict(const Chunk<Message>& chunk) const {
    const auto message = messages_.find(first_sequence(chunk));
    if (message == messages_.end()) return std::nullopt;
    const Chunk<Message>& other = message->second.front();
    if (other.identity == chunk.identity) return std::nullopt;
    return other.sequence;
  }

  /// Adds a chunk that was not added before and has no conflict(). Returns all chunks of its
  /// message, in order, if it was the last one that was missing; else nothing.
  Chunks add(Chunk<Message> chunk) {
    const std::int64_t first = first_sequence(chunk);
    const auto count = static_cast<std::size_t>(chunk.count);
    bytes_ += bytes(chunk);
    Chunks& chunks = messages_[first];
    chunks.push_back(std::move(chunk));
    if (chunks.size() < count) return {};
    Chunks complete = take(first);
    std::sort(complete.begin(), complete.end(),
              [](const auto& a, const auto& b) { return a.index < b.index; });
    return complete;
  }

  /// Removes the chunks of this chunk's message, and returns their sequence numbers.
  std::vector<std::int64_t> drop(const Chunk<Message>& chunk) {
    return numbers(take(first_sequence(chunk)));
  }
  /// The same for every message that begins before `sequence`.
  std::vector<std::int64_t> drop_before(std::int64_t sequence) {
    std::vector<std::int64_t> dropped;
    while (!messages_.empty() && messages_.begin()->first < sequence) {
      const auto more = numbers(take(messages_.begin()->first));
      dropped.insert(dropped.end(), more.begin(), more.end());
    }
    return dropped;
  }

  /// The same for every message that has a chunk in `range`.
  std::vector<std::int64_t> drop_in(const SequenceRange& range) {
    std::vector<std::int64_t> dropped;
    auto message = messages_.upper_bound(range.first);
    if (message != messages_.begin()) --message;  // it may reach into the range
    while (message != messages_.end() && message->first <= range.last) {
      const std::int64_t first = message->first;
      const std::int64_t last = first + message->second.front().count - 1;
      ++message;
      if (last < range.first) continue;
      const auto more = numbers(take(first));
      dropped.insert(dropped.end(), more.begin(), more.end());
    }
    return dropped;
  }

  /// Removes the message with the lowest numbers, except the one that begins at `kept`. Returns
  /// false if there is none.
  bool drop_lowest(std::optional<std::int64_t> kept) {
    auto message = messages_.begin();
    if (message != messages_.end() && message->first == kept) ++message;
    if (message == messages_.end()) return false;
    take(message->first);
    return true;
  }

  /// Memory of all chunks.
  std::size_t bytes() const { return bytes_; }

  /// The sequence number of the message's first chunk, which identifies the message: chunks of a
  /// message have consecutive numbers.
  static std::int64_t first_sequence(const Chunk<Message>& chunk) {
    return chunk.sequence - chunk.index;
  }

 private:
  static std::vector<std::int64_t> numbers(const Chunks& chunks) {
    std::vector<std::int64_t> numbers;
    numbers.reserve(chunks.size());
    for (const Chunk<Message>& chunk : chunks) numbers.push_back(chunk.sequence);
    return numbers;
  }

  Chunks take(std::int64_t first_sequence) {
    const auto message = messages_.find(first_sequence);
    Chunks chunks = std::move(message->second);
    messages_.erase(message);
    for (const Chunk<Message>& chunk : chunks) bytes_ -= bytes(chunk);
    return chunks;
  }

  std::map<std::int64_t, Chunks> messages_;  // by first_sequence()
  std::size_t bytes_ = 0;
};

}  // namespace kintsugi
