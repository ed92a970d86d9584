#include "lcmtypes/log/whole_log_reader.hpp"

#include <system_error>

#include "lcmtypes/log/session_log.hpp"
#include "lcmtypes/signing/process_key.hpp"

namespace kintsugi {
namespace {

bool has_no_bytes(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::file_size(path, ignored) == 0;
}

}  // namespace

WholeLogReader::WholeLogReader(const std::filesystem::path& path)
    : WholeLogReader(path, log_trust()) {}

WholeLogReader::WholeLogReader(const std::filesystem::path& path, const MessageTrust& trust)
    : trust_(trust) {
  reader_.emplace(path, trust_);
  if (!is_session_log(path)) return;
  for (const int number : numbers_of_files(path)) {
    const std::filesystem::path file = numbered(path, number);
    // An empty one: its mapper was killed before the first event.
    if (number > 0 && !has_no_bytes(file)) rest_.push_back(file);
  }
}

std::optional<LogEvent> WholeLogReader::next() {
  while (true) {
    if (auto event = reader_->next()) {
      event->index = num_events_++;
      return event;
    }
    if (damage() || rest_.empty()) return {};
    reader_.emplace(rest_.front(), trust_);
    rest_.pop_front();
  }
}

}  // namespace kintsugi
