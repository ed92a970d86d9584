#pragma once
// The sessions in a log of a mapper.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/messages.hpp"
#include "mapper/session/mapped_frames.hpp"
#include "mapper/session/mapping_options.hpp"

namespace kintsugi::mapper {

/// The data of the event on kOptionsChannel. Bytes of options that are no UTF-8 are replaced.
Bytes encode_options(std::int64_t session, const MappingOptions& options);

/// One session of a log.
struct StoredSession {
  std::int64_t session = 0;
  MappingOptions options;
  FrameHistory frames;
  bool final_slice_begun = false;      ///< mapping had ended, the rest was being published
  std::int64_t slice_chunks_end = 0;   ///< one past the last chunk of the final slice; 0: open
  std::int64_t frame_chunks_end = 0;   ///< one past the last chunk of a raw frame stored whole
  std::int64_t last_frame_utime = -1;  ///< of that frame
  std::int64_t last_event_utime = 0;   ///< wall clock
  std::optional<MapperStatus> last_status;
};

/// The number and the options of a session, of the data of its event.
/// @throws std::runtime_error when it cannot be read
StoredSession decode_options(ByteView data);

/// A chunk of a stream in the log.
struct StoredChunk {
  std::string channel;
  std::int64_t session = 0;
  std::int64_t sequence = 0;
};

/// Collects the sessions from the events of a log, which must be read in order. What a rewritten
/// log tells of chunks that are not in it (chunk_fates.hpp) is only checked.
class StoredSessionReader {
 public:
  /// Which chunk the event contains; nullopt if it contains none.
  /// @throws std::runtime_error when the log does not begin with the options of a session, or a
  ///   message of the mapper is damaged
  std::optional<StoredChunk> read(const LogEvent& event);

  /// In the order in which they began.
  const std::vector<StoredSession>& sessions() const { return sessions_; }

 private:
  void begin_session(const LogEvent& event);
  StoredSession& session(std::int64_t number);
  StoredChunk read_slice_chunk(const LogEvent& event);
  StoredChunk read_keyframe_chunk(const LogEvent& event);
  StoredChunk read_frame_chunk(const LogEvent& event);

  std::vector<StoredSession> sessions_;
};

}  // namespace kintsugi::mapper
