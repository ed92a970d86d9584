#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <string>

#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/log/log_writer.hpp"

namespace kintsugi::mapper {

/// Where an event's data is.
struct LogPlace {
  std::int32_t file = 0;
  std::int32_t size = 0;  ///< bytes
  std::int64_t offset = 0;
};

/// A log in files of bounded size: NAME.lcm, NAME.1.lcm, NAME.2.lcm and so on, each a whole LCM
/// log. Not thread safe.
class LogFiles {
 public:
  using OnEvent = std::function<void(const LogEvent&, const LogPlace&)>;

  /// A new log; with an empty path one without a name, in TMPDIR or /var/tmp, never rotated.
  /// @throws std::runtime_error naming the file, with the cure, when it exists or cannot be made
  LogFiles(const std::filesystem::path& path, std::int64_t max_file_bytes);

  /// A log that is there, to be continued; `on_event` gets every event it holds. A half-written
  /// event at its end is cut off, and cut_off() says so.
  /// @throws std::runtime_error naming file and place when a file is missing, is damaged, is no LCM
  ///   log or is written by another process, and what `on_event` throws, with file and place;
  ///   nothing is changed then
  LogFiles(const std::filesystem::path& path, std::int64_t max_file_bytes, const OnEvent& on_event);

  /// Appends an event, to a new file when the last one is full. @throws as LogWriter::append()
  LogPlace append(std::int64_t utime, const std::string& channel, ByteView data);

  /// The file of a place; it stays where it is while others are added.
  const LogWriter& file_of(const LogPlace& place) const;

  std::int64_t size_bytes() const;
  /// What was cut off when the log was opened, a sentence; empty: nothing.
  const std::string& cut_off() const { return cut_off_; }

 private:
  void open_files();
  void read_events(const OnEvent& on_event);
  bool last_file_is_full(std::size_t event_bytes) const;

  std::filesystem::path path_;  ///< empty: no name
  std::int64_t max_file_bytes_;
  std::deque<LogWriter> files_;  ///< never empty, once made; they stay where they are
  std::string cut_off_;
};

}  // namespace kintsugi::mapper
