#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mapper/session/log_files.hpp"
#include "mapper/session/stored_sessions.hpp"

namespace kintsugi::mapper {

class StoredStream;

/// Everything that a mapper publishes, in an LCM log: from it chunks are sent again, and from it a
/// session is continued after a crash.
///
/// A full disk loses nothing at first: what cannot be written waits in memory, in order, and is
/// tried again. When too much waits, the oldest chunks go and cannot be sent again any more; poses
/// and statuses stay. Thread safe. What it has to say about the disk is logged once.
class SessionLog {
 public:
  struct Config {
    std::filesystem::path path;                     ///< empty: without a name, gone in the end
    bool resume = false;                            ///< continue the log that is there
    std::int64_t max_file_bytes = 1'000'000'000;    ///< then another file begins, >= 1,000,000
    std::size_t max_waiting_bytes = 256'000'000;    ///< that could not be written, > 0
    std::chrono::milliseconds retry_period{1'000};  ///< of writing after a failure, > 0

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::runtime_error as LogFiles does
  explicit SessionLog(const Config& config);
  ~SessionLog();
  SessionLog(const SessionLog&) = delete;
  SessionLog& operator=(const SessionLog&) = delete;

  /// What the log held when it was opened, oldest first.
  const std::vector<StoredSession>& sessions() const { return sessions_; }

  /// From now on messages of this session come. The first one of a new log is on disk after that.
  /// @throws std::runtime_error when it cannot be written to a new log, which is removed then
  void begin_session(std::int64_t session, const MappingOptions& options);

  /// Appends a message that is no chunk of a stream. Never fails.
  void add(const std::string& channel, ByteView message);

  /// The chunks of one session on one channel; lives as long as this.
  StoredStream& stream(const std::string& channel, std::int64_t session);

  /// Tries to write what waits, when it is time to. To be called now and then.
  void retry();

  struct Report {
    std::int64_t size_bytes = 0;     ///< on disk, all files
    std::int64_t waiting_bytes = 0;  ///< not on disk yet
    std::int64_t lost_chunks = 0;    ///< of this run, that cannot be sent again any more
    std::string problem;             ///< why it cannot be written just now; empty: it can
  };
  Report report() const;

 private:
  friend class StoredStream;
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    std::int64_t utime;
    std::string channel;
    Bytes data;
    StoredStream* stream;  ///< null: no chunk
    std::int64_t sequence;
  };

  LogFiles open(const Config& config);
  void index_stored(const StoredChunk& chunk, const LogPlace& place);
  // What follows is called with the mutex locked.
  void append(const std::string& channel, ByteView data, StoredStream* stream,
              std::int64_t sequence);
  void write(std::int64_t utime, const std::string& channel, ByteView data, StoredStream* stream,
             std::int64_t sequence);
  void write_waiting();
  void keep_waiting(Waiting event);
  void drop_oldest_chunk();
  void note_failure(const std::string& problem);

  const Config config_;
  mutable std::mutex mutex_;  ///< guards all that follows, and the indices of the streams
  std::map<std::pair<std::string, std::int64_t>, std::unique_ptr<StoredStream>> streams_;
  std::vector<StoredSession> sessions_;  ///< constant once made
  LogFiles files_;
  std::list<Waiting> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::int64_t lost_chunks_ = 0;
  std::string problem_;
  Clock::time_point next_try_;
};

}  // namespace kintsugi::mapper
