#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>

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
///
/// A durable one is written in batches: begin_batch(), append() and sync(), after which a power cut
/// takes nothing of it. Each batch begins with a mark, an event that tells that all before it is on
/// the disk. So damage behind the last mark is what a power cut has left of the last batch, and is
/// cut off; damage before it is something else, and is an error. A file has the name
/// NAME.partial.lcm until its first batch is on the disk, so that it is never there without.
class LogFiles {
 public:
  using OnEvent = std::function<void(const LogEvent&, const LogPlace&)>;
  struct Config {
    std::filesystem::path path;
    std::int64_t max_file_bytes = 0;
    bool durable = false;
  };

  /// A new log. With an empty path it is one unnamed file in TMPDIR or /var/tmp.
  /// @throws std::runtime_error naming the file, with a remedy, when it exists or cannot be created
  explicit LogFiles(Config config);

  /// Continues an existing log; `on_event` gets every event in it but marks. A half-written event
  /// at its end, or what a power cut has left of the last batch, is cut off, which cut_off()
  /// reports. A durable log is on the disk as a whole afterwards.
  /// @throws std::runtime_error naming file and position when a file is missing, is damaged, is not
  ///   an LCM log or is being written by another process, and for exceptions of `on_event`; the log
  ///   is not changed then
  LogFiles(Config config, const OnEvent& on_event);

  /// Appends an event. A log that is not durable continues in a new file when the last one is full.
  /// @throws as LogWriter::append()
  LogPlace append(std::int64_t utime, const std::string& channel, ByteView data);

  /// Of an event in its file.
  static std::int64_t event_bytes(const std::string& channel, ByteView data);
  /// Whether the last file has room for so many bytes of events; an empty one always has. Marks are
  /// not counted.
  bool has_room(std::int64_t bytes) const;
  /// Opens the file that follows the last one, and nothing more. @throws as LogWriter does
  LogWriter create_next() const;
  /// Continues in this file of create_next().
  void continue_in(LogWriter next) { files_.push_back(std::move(next)); }

  /// Where the last file ends.
  LogWriter::End end() const { return files_.back().end(); }
  /// Appends the mark of a batch; all before it is on the disk. @throws as append()
  void begin_batch(std::int64_t utime);
  /// Waits until the last file is on the disk, under its name.
  /// @throws std::system_error; what was appended since the last success has to be undone
  void sync();
  /// Cuts off what was appended after `end`, of the last file. Never fails: what is left is
  /// overwritten.
  void undo(const LogWriter::End& end);
  /// Removes a new log that has one file and is not needed.
  void remove();

  /// The file of a place. The reference stays valid while others are added.
  const LogWriter& file_of(const LogPlace& place) const;

  std::int64_t size_bytes() const;
  /// A sentence about what was cut off when the log was opened; empty: nothing.
  const std::string& cut_off() const { return cut_off_; }

 private:
  void open_files();
  void read_file(std::size_t number, const OnEvent& on_event);
  void sync_all();

  const Config config_;
  bool folder_is_synced_ = true;
  std::deque<LogWriter> files_;  ///< never empty after construction; references stay valid
  std::string cut_off_;
};

}  // namespace kintsugi::mapper
