#pragma once
// The times of frames that a session has mapped, as one event of its log.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::mapper {

/// Channels of these events, in the log only. In a log that was rewritten: all frames, in place of
/// their poses.
inline constexpr char kMappedFramesChannel[] = "MAPPER_MAPPED_FRAMES";
/// Those of them that were only tracked, not fused. Stored before the pose of the frame, so that
/// it is never known that a frame was mapped and not how.
inline constexpr char kTrackedOnlyChannel[] = "MAPPER_TRACKED_ONLY";

struct MappedFrames {
  std::int64_t session = 0;
  std::vector<std::int64_t> utimes;  ///< device time, microseconds, ascending
};

/// About 3 bytes for each frame.
Bytes encode_mapped_frames(std::int64_t session, std::span<const std::int64_t> utimes);

/// @throws std::runtime_error when they are damaged
MappedFrames decode_mapped_frames(ByteView data);

/// The frames of a session, which its log may tell more than once: device time, microseconds,
/// ascending.
struct FrameHistory {
  std::vector<std::int64_t> mapped_utimes;
  std::vector<std::int64_t> tracked_only_utimes;  ///< of those of them that were not fused

  /// Of the pose of a frame.
  void add(std::int64_t utime);
  /// Of an event on one of the channels above.
  void add(const std::string& channel, const MappedFrames& frames);
};

inline bool has_mapped_frames(const std::string& channel) {
  return channel == kMappedFramesChannel || channel == kTrackedOnlyChannel;
}

}  // namespace kintsugi::mapper
