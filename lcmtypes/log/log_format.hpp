#pragma once
// The LCM log format, as lcm-logger writes and lcm-logplayer reads it.
//
// A log is a row of events. An event: sync word (4 bytes), number in the log (8), time (8), bytes
// of the channel (4), bytes of the data (4), all big-endian; then channel and data.

#include <cstdint>

namespace kintsugi::log_format {

inline constexpr std::int64_t kEventHeaderBytes = 28;
inline constexpr std::int64_t kMaxChannelBytes = 63;  ///< of LCM
inline constexpr std::uint64_t kSyncWord = 0xEDA1DA01;

}  // namespace kintsugi::log_format
