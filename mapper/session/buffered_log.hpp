#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "mapper/session/chunk_index.hpp"
#include "mapper/session/log_batch.hpp"
#include "mapper/session/log_files.hpp"

namespace kintsugi::mapper {

/// The smallest limit for a file of a log.
inline constexpr std::int64_t kMinFileBytes = 1'000'000;

/// An LCM log that accepts events while the disk is full.
///
/// Events that cannot be written wait in memory, in order, and writing is tried again every
/// retry_period. When more than max_waiting_bytes wait, the oldest chunks are dropped; other events
/// (poses, statuses) are small and stay. Each problem is logged once. Thread safe.
///
/// With `durable`, a power cut takes at most what was appended in the last second. Then nothing
/// but a thread of the log touches the disk: every event waits in memory until that thread has
/// written and synced it, every sync_period; when the disk fails to sync, all since the last
/// success is written again. While the disk keeps up, is_safe() tells which chunks a power cut
/// cannot take.
class BufferedLog {
 public:
  struct Config {
    std::filesystem::path path;  ///< empty: an unnamed temporary file
    bool resume = false;         ///< continue an existing log
    std::int64_t max_file_bytes =
        1'000'000'000;                 ///< start another file above this, >= kMinFileBytes
    std::int64_t max_total_bytes = 0;  ///< of all files, for StoreLimit; 0: without limit
    std::size_t max_waiting_bytes = 256'000'000;    ///< in memory, > 0
    std::chrono::milliseconds retry_period{1'000};  ///< between attempts to write, > 0
    bool durable = false;
    /// Between the end of a sync and the next, > 0. An event that has just missed a sync waits for
    /// its end, this long, and for the next one: with a disk that syncs within 0.375 s at most 1 s.
    std::chrono::milliseconds sync_period{250};

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @param on_event receives the events of a log that is continued
  /// @throws std::runtime_error as LogFiles does
  BufferedLog(const Config& config, const LogFiles::OnEvent& on_event);
  ~BufferedLog();
  BufferedLog(const BufferedLog&) = delete;
  BufferedLog& operator=(const BufferedLog&) = delete;

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

  /// Whether the chunk may be sent, because it is where this log promises to keep it: always,
  /// unless durable. One that the disk has not taken within a second is not waited for.
  bool is_safe(const ChunkIndex& index, std::int64_t sequence) const;

  /// Tries to write the waiting events when retry_period has passed, and logs when a durable log
  /// falls behind. To be called regularly.
  void retry();

  /// The files that are full, and do not change any more.
  std::vector<LogPart> closed() const;
  /// @throws as LogFiles::create_base()
  std::shared_ptr<LogWriter> create_base() const;
  /// See LogFiles::remove_base().
  void remove_base() const { files_.remove_base(); }
  /// Replaces the first `count` files of closed() by the base, which has all of them that is
  /// needed, and removes them. A kill or a power cut at any moment leaves the old files or the new
  /// one.
  /// @param move tells the indexes where their chunks are now; nobody can ask for one meanwhile
  /// @throws std::system_error; nothing has changed then
  void replace_first(std::shared_ptr<LogWriter> base, std::size_t count,
                     const std::function<void()>& move);

  /// Tries a last time to write what waits. Nothing may be appended any more.
  void finish();

  struct Report {
    std::int64_t size_bytes = 0;     ///< on disk, all files
    std::int64_t waiting_bytes = 0;  ///< not on disk yet; if durable, not synced yet
    std::int64_t lost_chunks = 0;    ///< dropped in this run; they cannot be sent again
    std::string problem;             ///< why the last attempt to write failed, or that a durable
                                     ///< log is more than a second behind; empty: neither
  };
  Report report() const;

 private:
  using Clock = std::chrono::steady_clock;
  using Event = WaitingEvent;

  static LogFiles open(const Config& config, const LogFiles::OnEvent& on_event);
  void begin_new(const std::string& channel, ByteView data);
  void write_batches();
  // The mutex is locked when the following are called.
  std::size_t write_batch(std::unique_lock<std::mutex>& lock);
  void continue_in_next_file(std::unique_lock<std::mutex>& lock);
  void note_written(LogBatch& batch);
  Clock::duration behind() const;
  std::string behind_text() const;
  void append(const std::string& channel, ByteView data, ChunkIndex* index, std::int64_t sequence);
  void write(std::int64_t utime, const std::string& channel, ByteView data, ChunkIndex* index,
             std::int64_t sequence);
  void write_waiting();
  void keep_waiting(Event event);
  void drop_oldest_chunk();
  void note_failure(const std::string& problem);
  void note_success();

  const Config config_;
  mutable std::mutex mutex_;  ///< guards the members below
  LogFiles files_;            ///< of a durable log: only its thread writes, without the lock
  std::list<Event> waiting_;
  std::optional<LogBatch> batch_;  ///< that is being written; its events are constant
  std::size_t waiting_bytes_ = 0;  ///< with those of the batch
  std::int64_t size_bytes_ = 0;
  std::int64_t lost_chunks_ = 0;
  std::string problem_;
  Clock::time_point next_try_;
  bool is_behind_ = false;  ///< which was logged
  bool stopping_ = false;
  std::condition_variable wake_;
  std::thread thread_;  ///< of a durable log
};

}  // namespace kintsugi::mapper
