#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include "lcmtypes/stream/sent_store.hpp"
#include "mapper/session/chunk_fates.hpp"
#include "mapper/session/log_files.hpp"

namespace kintsugi::mapper {

/// Where the chunks of one stream are, by sequence number: 24 bytes of memory for each that is
/// there. Thread safe.
class ChunkIndex {
 public:
  enum class State {
    kMissing,   ///< cannot be read any more
    kWaiting,   ///< in memory, to be written
    kWritten,   ///< at place()
    kReplaced,  ///< not there any more, and not needed
  };
  struct Entry {
    std::int64_t sequence = 0;
    LogPlace place;
  };

  State state(std::int64_t sequence) const;
  /// Of a chunk with state kWritten.
  LogPlace place(std::int64_t sequence) const;
  ChunkFate fate(std::int64_t sequence) const;
  /// The lowest `max_ranges` ranges of replaced chunks, from `begin` on.
  std::vector<SequenceRange> replaced(std::int64_t begin, std::size_t max_ranges) const;

  void set_written(std::int64_t sequence, const LogPlace& place);
  void set_waiting(std::int64_t sequence);
  void set_missing(std::int64_t sequence);
  /// Adds what a rewritten log tells of chunks that were sent.
  void add_fates(const ChunkFates& fates);

  /// The files up to number `last_file` were rewritten as file 0: these chunks, in the order of
  /// their numbers, are all of this stream that is in it. `fates` tells of all that are not.
  void move(std::int32_t last_file, const std::vector<Entry>& kept, const ChunkFates& fates);

  /// The first sequence number that is not missing; end(): none.
  std::int64_t first() const;
  /// One past the last sequence number.
  std::int64_t end() const;

  /// Forgets the first missing chunk and all after it.
  void truncate_at_gap();
  /// Forgets the chunks from `sequence` on.
  void truncate(std::int64_t sequence);

 private:
  // The mutex is locked when the following are called.
  void set(std::int64_t sequence, const LogPlace& place);
  std::deque<Entry>::iterator lower_bound(std::int64_t sequence);
  const LogPlace* find(std::int64_t sequence) const;
  void forget_from(std::int64_t sequence);

  mutable std::mutex mutex_;
  std::deque<Entry> entries_;  ///< by sequence number; file < 0: not on disk
  ChunkFates fates_;
  std::int64_t end_ = 0;
};

}  // namespace kintsugi::mapper
