#pragma once
// Reads an LCM log event by event.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/signing/message_guard.hpp"

namespace kintsugi {

/// One recorded message.
struct LogEvent {
  std::int64_t index = 0;  ///< in the log
  std::int64_t utime = 0;  ///< when it was received, wall clock, microseconds
  std::string channel;
  ByteView data;  ///< without a signature; valid until the next call of next()
};

/// Reads an LCM log. It does not use lcm::LogFile, which allocates as much memory as an event
/// claims to need, searches for the next event after damage, and does not report where or why it
/// ended.
///
/// With a key, events that are not signed with it, or that came before, are left out, and a warning
/// tells how many: lcm-logger also records what no program on the bus has accepted.
class LogReader {
 public:
  /// With log_trust(). @throws std::runtime_error as below, and when the key cannot be read
  explicit LogReader(const std::filesystem::path& path);
  /// @throws std::runtime_error when `path` cannot be read, is empty or is not an LCM log; when
  ///   there is a key and no event is signed with it, or no key and the first event is signed
  LogReader(const std::filesystem::path& path, const MessageTrust& trust);

  /// The next event; nothing at the end of the log or at its first damage.
  /// @throws std::runtime_error when there is no key and the event is signed
  std::optional<LogEvent> next();

  /// After next() has returned nothing: where and how the log is damaged; nothing: it is whole.
  const std::optional<std::string>& damage() const { return damage_; }

  /// The damage is that the last event is incomplete, as after a writer was killed.
  bool is_cut_off() const { return is_cut_off_; }

  /// For a log that is being written: next() goes on with what has been appended since, also after
  /// an event that was cut off because the rest of it was not written yet.
  /// @throws std::runtime_error when the size of the file cannot be read
  void go_on();

  /// Bytes of all events up to the one that next() has returned; its data, with a signature, ends
  /// here.
  std::int64_t bytes_read() const { return position_; }

 private:
  std::int64_t size_of_file() const;
  void check_signatures(const MessageTrust& trust);
  void rewind();
  std::optional<LogEvent> read_event();
  std::nullopt_t stop(const std::string& what);

  std::filesystem::path path_;
  bool has_key_;
  MessageGuard guard_;
  std::ifstream file_;
  std::int64_t size_ = 0;
  std::int64_t position_ = 0;  // of the next event
  std::int64_t index_ = 0;
  Bytes data_;  // of the last event
  std::optional<std::string> damage_;
  bool is_cut_off_ = false;
};

}  // namespace kintsugi
