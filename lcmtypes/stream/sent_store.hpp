#pragma once
// What a stream has sent, kept for those who missed it.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi {

/// Encoded chunks by sequence number. add() is called from one thread; the rest may be called from
/// any.
class SentStore {
 public:
  SentStore() = default;
  SentStore(const SentStore&) = delete;
  SentStore& operator=(const SentStore&) = delete;
  virtual ~SentStore() = default;

  /// Called for every chunk before it is sent, with consecutive `sequence`.
  virtual void add(std::int64_t sequence, ByteView message) = 0;
  /// The chunk; nothing when it is not kept, or not any more.
  virtual std::optional<Bytes> find(std::int64_t sequence) const = 0;
  /// The oldest sequence number that can still be sent again; next_sequence(): none.
  virtual std::int64_t first_sequence() const = 0;
  /// One past the newest that was added.
  virtual std::int64_t next_sequence() const = 0;
};

/// The newest chunks, in memory.
class RecentChunks : public SentStore {
 public:
  /// Keeps `max_bytes` of encoded chunks, and the newest chunk in any case.
  explicit RecentChunks(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// From now on; chunks that are too many go at the next add().
  void set_max_bytes(std::size_t max_bytes);

  /// Throws std::invalid_argument when `sequence` is not next_sequence(); the first may be any.
  void add(std::int64_t sequence, ByteView message) override;
  std::optional<Bytes> find(std::int64_t sequence) const override;
  std::int64_t first_sequence() const override;
  std::int64_t next_sequence() const override;
  std::size_t bytes() const;  ///< of the chunks kept

 private:
  mutable std::mutex mutex_;  // guards what follows
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::int64_t next_sequence_ = 0;
  std::deque<Bytes> chunks_;  // the last of them is next_sequence_ - 1
};

}  // namespace kintsugi
