#pragma once
// What has become of the chunks of a stream that a rewritten log has not as they were sent.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/sequence_set.hpp"

namespace kintsugi::mapper {

/// See ChunkFate. `superseded` is a part of `replaced`; what is in `replaced` and in `changed` is
/// replaced.
struct ChunkFates {
  SequenceSet replaced;
  SequenceSet superseded;
  SequenceSet changed;

  void add(const ChunkFates& others);
};

/// The fates of one stream.
struct FatesOfStream {
  std::string channel;
  std::int64_t session = 0;
  ChunkFates fates;
};

/// As events of a log: channel and data. Replaced ones are told on CHUNKS_REPLACED, as on the bus,
/// so that every reader of the log knows of them; the others on channels that are in logs only.
/// @param map_name of the map that the stream carries
std::vector<std::pair<std::string, Bytes>> encode_fates(const FatesOfStream& stream,
                                                        const std::string& map_name);

/// What the event tells; nullopt if it is none of these. @throws DecodeError
std::optional<FatesOfStream> decode_fates(const LogEvent& event);

}  // namespace kintsugi::mapper
