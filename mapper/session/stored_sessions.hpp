#pragma once
// What a log of a mapper says about the sessions in it.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/messages.hpp"

namespace kintsugi::mapper {

/// In the log only, at the start of each session: which one it is, and how it maps (JSON).
inline constexpr char kOptionsChannel[] = "MAPPER_OPTIONS";

/// How a session maps: name of the option and its value. What is equal maps the same frames to the
/// same slices.
using MappingOptions = std::map<std::string, std::string>;

/// The data of an event on kOptionsChannel.
Bytes encode_options(std::int64_t session, const MappingOptions& options);

/// One session of a log.
struct StoredSession {
  std::int64_t session = 0;
  MappingOptions options;
  std::vector<std::int64_t> mapped_utimes;  ///< of the frames that were mapped, ascending
  bool final_slice_begun = false;           ///< the session was ending
  std::int64_t slice_chunks_end = 0;        ///< one past the last chunk of the final slice; 0: open
  std::int64_t frame_chunks_end = 0;        ///< one past the last chunk of a raw frame stored whole
  std::int64_t last_frame_utime = -1;       ///< of that frame
  std::int64_t last_event_utime = 0;        ///< wall clock
  std::optional<MapperStatus> last_status;
};

/// A chunk of a stream in the log.
struct StoredChunk {
  std::string channel;
  std::int64_t session = 0;
  std::int64_t sequence = 0;
};

/// Reads events in the order of the log.
class StoredSessionReader {
 public:
  /// What the event is a chunk of; nothing for anything else.
  /// @throws std::runtime_error when the log does not begin as the mapper begins one, or a message
  ///   of the mapper is damaged
  std::optional<StoredChunk> read(const LogEvent& event);

  /// In the order in which they began.
  std::vector<StoredSession> sessions() && { return std::move(sessions_); }

 private:
  void begin_session(const LogEvent& event);
  StoredSession& session(std::int64_t number);
  StoredChunk read_slice_chunk(const LogEvent& event);
  StoredChunk read_frame_chunk(const LogEvent& event);

  std::vector<StoredSession> sessions_;
};

}  // namespace kintsugi::mapper
