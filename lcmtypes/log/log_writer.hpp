#pragma once
// An LCM log being written, and read again where it was written.

#include <cstdint>
#include <filesystem>
#include <string>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi {

/// Appends events to one file, each whole or not at all: lcm-logplayer and LogReader read what is
/// there at any moment.
///
/// What was appended outlives the process (SIGKILL), not a power failure: nothing is forced to
/// disk. The file is locked while it is open, so that two processes never write one log. Not thread
/// safe but for read(), which may run beside append().
class LogWriter {
 public:
  /// A new file. @throws std::system_error naming it: it exists, or cannot be made
  static LogWriter create(const std::filesystem::path& path);
  /// A file that is there, to be read and to be continued at its end (see continue_after()).
  /// @throws std::system_error naming it: it cannot be opened, or another process writes it
  static LogWriter open(const std::filesystem::path& path);
  /// A file without a name in `folder`, gone when it is closed. @throws std::system_error
  static LogWriter temporary(const std::filesystem::path& folder);

  ~LogWriter();
  LogWriter(LogWriter&& other) noexcept;
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;
  LogWriter& operator=(LogWriter&&) = delete;

  /// The next event goes behind the first `bytes` bytes, which hold `events` events; what lies
  /// beyond is cut off. @throws std::system_error
  void continue_after(std::int64_t bytes, std::int64_t events);

  /// Appends an event and returns the place of its data. `channel` has 1 to 63 bytes.
  /// @throws std::system_error naming file and reason (a full disk); the file is as it was then
  std::int64_t append(std::int64_t utime, const std::string& channel, ByteView data);

  /// The `size` bytes of data that append() said are at `place`.
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
