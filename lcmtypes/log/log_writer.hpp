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
/// Events survive when the process is killed, but not a power failure, because the file is not
/// synced to disk. The file is locked while it is open, so that two processes never write the same
/// log. Not thread safe, except that read() may run in parallel to append().
class LogWriter {
 public:
  /// Creates a file. @throws std::system_error naming it when it exists or cannot be created
  static LogWriter create(const std::filesystem::path& path);
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

  /// Cuts the file after its first `bytes` bytes, which are `events` events, and continues there.
  /// @throws std::system_error
  void continue_after(std::int64_t bytes, std::int64_t events);

  /// Appends an event and returns the place of its data in the file. `channel` has 1 to 63 bytes.
  /// @throws std::system_error naming file and reason, such as a full disk; the file is unchanged
  /// then
  std::int64_t append(std::int64_t utime, const std::string& channel, ByteView data);

  /// Reads `size` bytes at a place that append() has returned.
  /// @throws std::system_error when they cannot be read, std::runtime_error when the file is
  /// shorter
  Bytes read(std::int64_t place, std::size_t size) const;

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
