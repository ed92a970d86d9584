#pragma once
// An LCM log, event by event.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "lcmtypes/codec.hpp"

namespace lcm {
class LogFile;
}

namespace kintsugi {

/// One recorded message. `data` is valid until the next call of next().
struct LogEvent {
  std::int64_t index = 0;  ///< in the log
  std::int64_t utime = 0;  ///< when it was received, wall clock, microseconds
  std::string channel;
  ByteView data;
};

class LogReader {
 public:
  /// Throws std::runtime_error when `path` cannot be read, is empty or is no LCM log.
  explicit LogReader(const std::filesystem::path& path);
  ~LogReader();
  LogReader(const LogReader&) = delete;
  LogReader& operator=(const LogReader&) = delete;

  /// The next event; nothing at the end of what can be read.
  std::optional<LogEvent> next();

  /// After next() returned nothing: where and how the log is damaged; nothing when it is whole.
  const std::optional<std::string>& damage() const { return damage_; }

  std::int64_t bytes_read() const { return position_; }
  std::int64_t bytes_total() const { return size_; }

 private:
  bool next_event_is_whole();

  std::filesystem::path path_;
  std::unique_ptr<lcm::LogFile> log_;
  std::int64_t size_ = 0;
  std::int64_t position_ = 0;  // of the next event
  std::int64_t index_ = 0;
  std::optional<std::string> damage_;
};

}  // namespace kintsugi
