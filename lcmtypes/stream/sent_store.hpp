#pragma once
// Keeps the chunks that a stream has sent, to resend them.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi {

/// What has become of a chunk that was added to a store.
enum class ChunkFate {
  kKept,
  kChanged,     ///< there is another one in its place, of which others need no more
  kReplaced,    ///< newer chunks have replaced it: nobody needs it, and it is not there any more
  kSuperseded,  ///< likewise, and it was all that was sent of a message that was superseded
};

/// Encoded chunks by sequence number. Only one thread may call add(); any thread may call the other
/// functions.
class SentStore {
 public:
  SentStore() = default;
  SentStore(const SentStore&) = delete;
  SentStore& operator=(const SentStore&) = delete;
  virtual ~SentStore() = default;

  /// Adds a chunk before it is sent; `sequence` is consecutive.
  virtual void add(std::int64_t sequence, ByteView message) = 0;
  /// The chunk; nothing if it is not in the store, or no longer.
  virtual std::optional<Bytes> find(std::int64_t sequence) const = 0;
  /// The lowest sequence number in the store; next_sequence() if it is empty.
  virtual std::int64_t first_sequence() const = 0;
  /// One past the highest sequence number that was added.
  virtual std::int64_t next_sequence() const = 0;
  /// Whether a chunk that was added may be sent: not before the store has it where it promises to
  /// keep it.
  virtual bool is_safe(std::int64_t /*sequence*/) const { return true; }
  virtual ChunkFate fate(std::int64_t /*sequence*/) const { return ChunkFate::kKept; }
  /// The ranges of chunks from `begin` on that were replaced, the lowest `max_ranges` of them.
  virtual std::vector<SequenceRange> replaced(std::int64_t /*begin*/,
                                              std::size_t /*max_ranges*/) const {
    return {};
  }
};

/// Keeps the newest chunks in memory.
class RecentChunks : public SentStore {
 public:
  /// @param max_bytes of encoded chunks; the newest chunk is kept in any case
  explicit RecentChunks(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Changes the limit; the next add() removes chunks that exceed it.
  void set_max_bytes(std::size_t max_bytes);

  /// @throws std::invalid_argument when `sequence` is not next_sequence(); the first may be any
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
