#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <string>

#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/log/log_writer.hpp"

namespace kintsugi::mapper {

/// Position of the data of an event.
struct LogPlace {
  std::int32_t file = 0;
  std::int32_t size = 0;  ///< bytes
  std::int64_t offset = 0;
};

/// A log in files of bounded size: NAME.lcm, NAME.1.lcm, NAME.2.lcm and so on, each a valid LCM
/// log. Not thread safe.
class LogFiles {
 public:
  using OnEvent = std::function<void(const LogEvent&, const LogPlace&)>;

  /// A new log. With an empty path it is one unnamed file in TMPDIR or /var/tmp.
  /// @throws std::runtime_error naming the file, with a remedy, when it exists or cannot be created
  LogFiles(const std::filesystem::path& path, std::int64_t max_file_bytes);

  /// Continues an existing log; `on_event` gets every event in it. A half-written event at its end
  /// is cut off, which cut_off() reports.
  /// @throws std::runtime_error naming file and position when a file is missing, is damaged, is not
  ///   an LCM log or is being written by another process, and for exceptions of `on_event`; the log
  ///   is not changed then
  LogFiles(const std::filesystem::path& path, std::int64_t max_file_bytes, const OnEvent& on_event);

  /// Appends an event, to a new file when the last one is full. @throws as LogWriter::append()
  LogPlace append(std::int64_t utime, const std::string& channel, ByteView data);

  /// The file of a place. The reference stays valid while others are added.
  const LogWriter& file_of(const LogPlace& place) const;

  std::int64_t size_bytes() const;
  /// A sentence about what was cut off when the log was opened; empty: nothing.
  const std::string& cut_off() const { return cut_off_; }

 private:
  void open_files();
  void read_events(const OnEvent& on_event);
  bool last_file_is_full(std::size_t event_bytes) const;

  std::filesystem::path path_;  ///< empty: unnamed
  std::int64_t max_file_bytes_;
  std::deque<LogWriter> files_;  ///< never empty after construction; references stay valid
  std::string cut_off_;
};

}  // namespace kintsugi::mapper
