#pragma once

#include <chrono>
#include <cstdint>
#include <list>
#include <string>
#include <vector>

#include "mapper/session/chunk_index.hpp"
#include "mapper/session/log_files.hpp"

namespace kintsugi::mapper {

/// An event that is not in the log yet.
struct WaitingEvent {
  std::int64_t utime;
  std::string channel;
  Bytes data;
  ChunkIndex* index;  ///< null: not a chunk of a stream
  std::int64_t sequence;
  std::chrono::steady_clock::time_point since;
};

/// Events of a durable log that reach the disk together.
struct LogBatch {
  std::list<WaitingEvent> events;
  std::vector<LogPlace> places;  ///< of the first of them, as many as are on the disk
  std::string problem;           ///< why the others are not; empty: all are

  /// Takes the events from the front of `waiting` that the last file has room for, one at least,
  /// and of about 16 MB: after a disk has stood still, not all that waits hangs on one sync.
  static LogBatch take_from(std::list<WaitingEvent>& waiting, const LogFiles& files);

  /// Writes the events and waits until they are on the disk. What the disk has no room for is left
  /// out; when it cannot be synced nothing is written.
  void write(LogFiles& files);
};

}  // namespace kintsugi::mapper
