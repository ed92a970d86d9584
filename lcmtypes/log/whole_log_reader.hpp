#pragma once
// Reads a log that may be in several files.

#include <deque>
#include <filesystem>
#include <optional>
#include <string>

#include "lcmtypes/log/log_reader.hpp"

namespace kintsugi {

/// A LogReader that goes on in the next file where a mapper has (--store-file-size). Logs of others
/// are one file: what lies beside it under a number is another recording.
class WholeLogReader {
 public:
  /// With log_trust(). @throws std::runtime_error as LogReader, and when a file is missing
  explicit WholeLogReader(const std::filesystem::path& path);
  /// @throws std::runtime_error as LogReader, and when a file is missing
  WholeLogReader(const std::filesystem::path& path, const MessageTrust& trust);

  /// The next event; nothing at the end of the last file or at the first damage.
  /// @throws std::runtime_error as LogReader, also of its constructor
  std::optional<LogEvent> next();

  /// After next() has returned nothing: where and how the log is damaged; nothing: it is whole.
  const std::optional<std::string>& damage() const { return reader_->damage(); }

 private:
  MessageTrust trust_;
  std::optional<LogReader> reader_;
  std::deque<std::filesystem::path> rest_;
  std::int64_t num_events_ = 0;
};

}  // namespace kintsugi
