#pragma once
// What the first files of a log have, and where.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/messages.hpp"
#include "mapper/session/chunk_fates.hpp"
#include "mapper/session/log_files.hpp"
#include "mapper/session/mapped_frames.hpp"

namespace kintsugi::mapper {

/// An event, without its data.
struct PlacedEvent {
  LogPlace place;
  std::int64_t utime = 0;
};

/// A slice whose chunks, or some of them, are in the files.
struct PlacedSlice {
  std::int64_t sequence = 0;  ///< of its first chunk
  std::int32_t id = 0;
  std::int32_t revision = 0;
  SliceKind kind = SliceKind::kFinal;
  bool superseded = false;
  std::vector<std::optional<PlacedEvent>> chunks;  ///< nullopt: not in the files

  bool is_whole() const;
};

/// One session.
struct SessionContents {
  std::int64_t session = 0;
  std::string map_name;
  PlacedEvent options;
  FrameHistory frames;
  std::map<std::int64_t, PlacedSlice> slices;  ///< by PlacedSlice::sequence
  std::map<std::string, ChunkFates> fates;     ///< by the channel of the stream
  std::map<std::string, std::map<std::int64_t, PlacedEvent>>
      other_chunks;                                  ///< by channel, sequence
  std::map<std::string, PlacedEvent> last_messages;  ///< by channel: status, and heartbeats
};

/// Collects it from the events of the files, which must be read in order.
class LogContents {
 public:
  /// @throws std::runtime_error or DecodeError when a message of the mapper is damaged
  void read(const LogEvent& event, const LogPlace& place);

  /// In the order in which they began.
  const std::vector<SessionContents>& sessions() const { return sessions_; }

 private:
  SessionContents& session(std::int64_t number);
  void read_slice_chunk(const LogEvent& event, const PlacedEvent& placed);
  template <BulkMessage Message>
  void read_other_chunk(const LogEvent& event, const PlacedEvent& placed);

  std::vector<SessionContents> sessions_;
};

}  // namespace kintsugi::mapper
