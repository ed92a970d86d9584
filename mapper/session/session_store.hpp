#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "mapper/session/buffered_log.hpp"
#include "mapper/session/mapping_options.hpp"
#include "mapper/session/store_limit.hpp"
#include "mapper/session/stored_sessions.hpp"
#include "mapper/session/stored_stream.hpp"

namespace kintsugi::mapper {

/// The sessions of a mapper in an LCM log: every message that it publishes, from which lost chunks
/// are sent again and an interrupted session is continued. Thread safe.
class SessionStore {
 public:
  using Config = BufferedLog::Config;

  /// @throws std::runtime_error as LogFiles does
  explicit SessionStore(const Config& config);
  SessionStore(const SessionStore&) = delete;
  SessionStore& operator=(const SessionStore&) = delete;

  /// The sessions in the log when it was opened, oldest first.
  const std::vector<StoredSession>& sessions() const { return reader_.sessions(); }

  /// Begins a run. In a new log its options are on disk afterwards.
  /// @throws std::runtime_error when they cannot be written to a new log, which is then removed
  void begin_session(std::int64_t session, const MappingOptions& options);

  /// Appends a message that is not a chunk of a stream. Never fails.
  void add(const std::string& channel, ByteView message) { log_.append(channel, message); }

  /// The chunks of one session on one channel. The stream lives as long as this.
  StoredStream& stream(const std::string& channel, std::int64_t session);

  /// Tries to write what could not be written before, and keeps the limit. To be called regularly,
  /// by one thread.
  void retry();
  /// Tries a last time. Nothing may be added any more.
  void finish();

  /// The problem is that of the log, or else that the map is larger than the limit permits.
  BufferedLog::Report report() const;

 private:
  void read_event(const LogEvent& event, const LogPlace& place);
  void move_chunks(std::int32_t last_file, const RewrittenStreams& streams);

  std::mutex mutex_;  ///< guards streams_
  std::map<std::pair<std::string, std::int64_t>, std::unique_ptr<StoredStream>> streams_;
  StoredSessionReader reader_;  ///< constant after the constructor
  BufferedLog log_;
  StoreLimit limit_;  ///< last: it has a thread
};

}  // namespace kintsugi::mapper
