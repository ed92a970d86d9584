#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <mutex>
#include <optional>
#include <string>

#include "mapper/session/chunk_index.hpp"
#include "mapper/session/log_files.hpp"

namespace kintsugi::mapper {

/// An LCM log that accepts events while the disk is full.
///
/// Events that cannot be written wait in memory, in order, and writing is tried again every
/// retry_period. When more than max_waiting_bytes wait, the oldest chunks are dropped; other events
/// (poses, statuses) are small and stay. Each problem is logged once. Thread safe.
class BufferedLog {
 public:
  struct Config {
    std::filesystem::path path;                     ///< empty: an unnamed temporary file
    bool resume = false;                            ///< continue an existing log
    std::int64_t max_file_bytes = 1'000'000'000;    ///< start another file above this, >= 1,000,000
    std::size_t max_waiting_bytes = 256'000'000;    ///< in memory, > 0
    std::chrono::milliseconds retry_period{1'000};  ///< between attempts to write, > 0

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @param on_event receives the events of a log that is continued
  /// @throws std::runtime_error as LogFiles does
  BufferedLog(const Config& config, const LogFiles::OnEvent& on_event);

  /// Appends the first event. In a new log it is on disk afterwards.
  /// @throws std::runtime_error when it cannot be written to a new log, which is then removed
  void begin(const std::string& channel, ByteView data);

  /// Appends an event. Never fails.
  void append(const std::string& channel, ByteView data);
  /// Appends chunk number `sequence` of a stream and keeps its state in `index`, which must outlive
  /// this. Never fails.
  void append_chunk(const std::string& channel, ByteView data, ChunkIndex& index,
                    std::int64_t sequence);

  /// The data of a chunk; nullopt when it is missing or cannot be read.
  std::optional<Bytes> find(const ChunkIndex& index, std::int64_t sequence) const;

  /// Tries to write the waiting events when retry_period has passed. To be called regularly.
  void retry();

  struct Report {
    std::int64_t size_bytes = 0;     ///< on disk, all files
    std::int64_t waiting_bytes = 0;  ///< not on disk yet
    std::int64_t lost_chunks = 0;    ///< dropped in this run; they cannot be sent again
    std::string problem;             ///< why the last attempt to write failed; empty: it did not
  };
  Report report() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Event {
    std::int64_t utime;
    std::string channel;
    Bytes data;
    ChunkIndex* index;  ///< null: not a chunk of a stream
    std::int64_t sequence;
  };

  static LogFiles open(const Config& config, const LogFiles::OnEvent& on_event);
  // The mutex is locked when the following are called.
  void append(const std::string& channel, ByteView data, ChunkIndex* index, std::int64_t sequence);
  void write(std::int64_t utime, const std::string& channel, ByteView data, ChunkIndex* index,
             std::int64_t sequence);
  void write_waiting();
  void keep_waiting(Event event);
  void drop_oldest_chunk();
  void note_failure(const std::string& problem);

  const Config config_;
  mutable std::mutex mutex_;  ///< guards the members below
  LogFiles files_;
  std::list<Event> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::int64_t lost_chunks_ = 0;
  std::string problem_;
  Clock::time_point next_try_;
};

}  // namespace kintsugi::mapper
