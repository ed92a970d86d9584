#pragma once
// The format of LCM logs, which lcm-logger writes and lcm-logplayer reads.
//
// A log is a sequence of events. An event has a sync word (4 bytes), its number in the log (8),
// time in microseconds (8), number of bytes of the channel (4) and of the data (4), all big-endian;
// then the channel and the data.

#include <cstdint>

namespace kintsugi::log_format {

inline constexpr std::int64_t kEventHeaderBytes = 28;
inline constexpr std::int64_t kMaxChannelBytes = 63;  ///< LCM's limit
inline constexpr std::uint64_t kSyncWord = 0xEDA1DA01;
/// LCM publishes on it, unsigned, when a program opens a bus, and lcm-logger records that.
inline constexpr char kSelfTestChannel[] = "LCM_SELF_TEST";

}  // namespace kintsugi::log_format
