#pragma once
// Rewrites the first files of a log as one that has only what is needed of them.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mapper/session/chunk_index.hpp"
#include "mapper/session/log_files.hpp"

namespace kintsugi::mapper {

/// Where the chunks of a stream are in the new file, and what has become of the others.
struct RewrittenStream {
  std::vector<ChunkIndex::Entry> kept;  ///< by sequence number
  ChunkFates fates;
};
/// By channel and session.
using RewrittenStreams = std::map<std::pair<std::string, std::int64_t>, RewrittenStream>;

/// Writes the base that can replace `parts`, the first files of a log, all of which are full. It
/// has
///
/// - the options of each session, so that it can be resumed,
/// - the times of the frames that were mapped, without their poses,
/// - the slices that SliceNeeds names, and which chunks of others were there,
/// - all keyframes and raw frames,
/// - the last status and heartbeats.
///
/// @param base an empty file
/// @param is_marked with the mark of a durable log at its end
/// @param is_stopped asked now and then; true: an exception ends the work
/// @throws std::runtime_error when something cannot be read or written
RewrittenStreams rewrite_log(const std::vector<LogPart>& parts, LogWriter& base, bool is_marked,
                             const std::function<bool()>& is_stopped);

}  // namespace kintsugi::mapper
