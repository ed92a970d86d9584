#pragma once

#include <cstdint>
#include <deque>
#include <mutex>

#include "mapper/session/log_files.hpp"

namespace kintsugi::mapper {

/// Where the chunks of one stream are, by sequence number: 16 bytes of memory for each. Thread
/// safe.
class ChunkIndex {
 public:
  enum class State {
    kMissing,  ///< cannot be read any more
    kWaiting,  ///< in memory, to be written
    kWritten,  ///< at place()
  };

  State state(std::int64_t sequence) const;
  /// Of a chunk with state kWritten.
  LogPlace place(std::int64_t sequence) const;

  void set_written(std::int64_t sequence, const LogPlace& place);
  void set_waiting(std::int64_t sequence);
  void set_missing(std::int64_t sequence);

  /// The first sequence number that is not missing; end(): none.
  std::int64_t first() const;
  /// One past the last sequence number.
  std::int64_t end() const;

  /// Forgets the first missing chunk and all after it.
  void truncate_at_gap();
  /// Forgets the chunks from `sequence` on.
  void truncate(std::int64_t sequence);

 private:
  void set(std::int64_t sequence, const LogPlace& place);

  mutable std::mutex mutex_;
  std::deque<LogPlace> places_;  ///< by sequence number; file < 0: not on disk
};

}  // namespace kintsugi::mapper
