#pragma once
// The times of the frames that a session has mapped, as one event of a log that was rewritten: in
// place of their poses.

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::mapper {

/// Channel of these events, in the log only.
inline constexpr char kMappedFramesChannel[] = "MAPPER_MAPPED_FRAMES";

struct MappedFrames {
  std::int64_t session = 0;
  std::vector<std::int64_t> utimes;  ///< device time, microseconds, ascending
};

/// About 3 bytes for each frame.
Bytes encode_mapped_frames(std::int64_t session, std::span<const std::int64_t> utimes);

/// @throws std::runtime_error when they are damaged
MappedFrames decode_mapped_frames(ByteView data);

}  // namespace kintsugi::mapper
