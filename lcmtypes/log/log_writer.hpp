#pragma once
// Writes an LCM log, and reads back what was written.

#include <cstdint>
#include <filesystem>
#include <string>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi {

/// Appends events to one file, each completely or not at all: LogReader and lcm-logplayer can read
/// the file at any moment.
///
/// Events survive when the process is killed; a power cut takes those since the last sync(). The
/// file is locked while it is open, so that two processes never write the same log. Not thread
/// safe, except that read() may run in parallel to the other functions.
class LogWriter {
 public:
  /// Creates a file. @throws std::system_error naming it when it exists or cannot be created
  static LogWriter create(const std::filesystem::path& path);
  /// Creates a file, or empties the one that is there.
  /// @throws std::system_error naming it when it cannot be created or another process writes it
  static LogWriter create_anew(const std::filesystem::path& path);
  /// Opens an existing file, to read it and to continue it (see continue_after()).
  /// @throws std::system_error naming it when it cannot be opened or another process writes it
  static LogWriter open(const std::filesystem::path& path);
  /// Creates a file without a name in `folder`, which is deleted when it is closed.
  /// @throws std::system_error
  static LogWriter temporary(const std::filesystem::path& folder);

  ~LogWriter();
  LogWriter(LogWriter&& other) noexcept;
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;
  LogWriter& operator=(LogWriter&&) = delete;

  /// What a log that is whole ends with.
  struct End {
    std::int64_t bytes = 0;
    std::int64_t events = 0;
  };
  End end() const { return {size_, num_events_}; }

  /// Cuts the file after `end`, and continues there. @throws std::system_error; the next event
  /// overwrites what was to be cut then
  void continue_after(const End& end);

  /// Appends an event and returns the place of its data in the file. `channel` has 1 to 63 bytes.
  /// @throws std::system_error naming file and reason, such as a full disk; the file is unchanged
  /// then
  std::int64_t append(std::int64_t utime, const std::string& channel, ByteView data);

  /// Waits until all events are on the disk. Their file may still have no entry in its folder
  /// there.
  /// @throws std::system_error naming file and reason; the events since the last success have to be
  /// written again then
  void sync();

  /// Gives the file another name. Where a file with this name exists, it is not replaced.
  /// @throws std::system_error
  void rename(const std::filesystem::path& path);

  /// The same, but a file with this name is replaced. @throws std::system_error
  void replace(const std::filesystem::path& path);

  /// Reads `size` bytes at a place that append() has returned.
  /// @throws std::system_error when they cannot be read, std::runtime_error when the file is
  /// shorter
  Bytes read(std::int64_t place, std::size_t size) const;

  /// A path at which a LogReader finds this file for as long as it is open, also one without a
  /// name, or after another one has got its name.
  std::filesystem::path open_path() const;

  std::int64_t size_bytes() const { return size_; }
  const std::filesystem::path& path() const { return path_; }

 private:
  LogWriter(std::filesystem::path path, int flags);

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::int64_t size_ = 0;
  std::int64_t num_events_ = 0;
};

}  // namespace kintsugi
