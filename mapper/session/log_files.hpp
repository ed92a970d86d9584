#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/log/log_writer.hpp"

namespace kintsugi::mapper {

/// Position of the data of an event.
struct LogPlace {
  std::int32_t file = 0;
  std::int32_t size = 0;  ///< bytes
  std::int64_t offset = 0;
};

/// A file of a log. Its number does not change, its place in a list does.
struct LogPart {
  std::int32_t number = 0;
  std::shared_ptr<LogWriter> file;
};

/// A log in files of bounded size: NAME.lcm, NAME.1.lcm, NAME.2.lcm and so on, each a valid LCM
/// log. Not thread safe.
///
/// The first files can be replaced by one, the base, that has what is still needed of them. It is
/// number 0, too, and says with which number the log goes on (log_base.hpp).
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

  /// A new log. With an empty path its files are unnamed, in TMPDIR or /var/tmp.
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
  /// Whether so many bytes of events fit into the last file. Marks are not counted.
  bool has_room(std::int64_t bytes) const;
  /// The same of one event, for which an empty file always has room.
  bool takes(std::int64_t event_bytes) const;
  /// Opens the file that follows the last one, and nothing more. @throws as LogWriter does
  LogWriter create_next() const;
  /// Continues in this file of create_next().
  void continue_in(LogWriter next);

  /// Opens a file for what shall replace the first ones; has no effect on the log.
  /// @throws as LogWriter does
  LogWriter create_base() const;
  /// Removes the file of create_base(), if it was not installed.
  void remove_base() const;
  /// Gives the file of create_base(), which is whole, the name of the first file of the log, so
  /// that a log that is opened from now on begins with it, also after a power cut. May run in
  /// parallel to all others. @throws std::system_error; the log has its old first file then
  void install(LogWriter& base) const;
  /// All files but the last, which may grow. They do not change.
  std::vector<LogPart> closed() const { return closed_; }
  /// Uses the base that was installed instead of the first `count` files of closed().
  void use(std::shared_ptr<LogWriter> base, std::size_t count);
  /// Removes what is left of these files, which are not used any more.
  void remove(const std::vector<LogPart>& parts) const;

  /// Where the last file ends.
  LogWriter::End end() const { return last_.file->end(); }
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

  /// The file of a place, which stays open for as long as somebody has it.
  std::shared_ptr<const LogWriter> file_of(const LogPlace& place) const;

  std::int64_t size_bytes() const;
  /// A sentence about what was cut off when the log was opened; empty: nothing.
  const std::string& cut_off() const { return cut_off_; }

 private:
  std::vector<LogPart> all() const;
  void open_files();
  void read_file(const LogPart& part, const OnEvent& on_event);
  void sync_all();

  const Config config_;
  bool folder_is_synced_ = true;
  std::vector<LogPart> closed_;  ///< by number
  LogPart last_;
  std::int32_t next_number_ = 1;
  std::string cut_off_;
};

}  // namespace kintsugi::mapper
