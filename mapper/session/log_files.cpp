#include "mapper/session/log_files.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "lcmtypes/log/log_format.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

/// What the mapper writes is smaller: more than this was not left by an interrupted write.
constexpr std::int64_t kMaxEventBytes = 262'144;

fs::path numbered(const fs::path& path, int number) {
  if (number == 0) return path;
  return path.parent_path() /
         (path.stem().string() + '.' + std::to_string(number) + path.extension().string());
}

/// The largest number that a file of this log bears; 0: there is only the first, or none.
int last_number(const fs::path& path) {
  const std::string begin = path.stem().string() + ".";
  const std::string end = path.extension().string();
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  int last = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(begin) || !name.ends_with(end) ||
        name.size() <= begin.size() + end.size()) {
      continue;
    }
    const char* const digits_end = name.data() + (name.size() - end.size());
    int number = 0;
    const auto parsed = std::from_chars(name.data() + begin.size(), digits_end, number);
    if (parsed.ec == std::errc() && parsed.ptr == digits_end) last = std::max(last, number);
  }
  return last;
}

LogWriter create_named(const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) {
    throw std::runtime_error("log '" + path.string() +
                             "' exists: continue it with --resume, or give --store another name");
  }
  if (const int number = last_number(path); number > 0) {
    throw std::runtime_error("log '" + numbered(path, number).string() +
                             "' of an earlier run exists: remove it, or give --store another name");
  }
  return LogWriter::create(path);
}

LogWriter create_unnamed() {
  const char* folder = std::getenv("TMPDIR");
  try {
    return LogWriter::temporary(folder != nullptr && *folder != '\0' ? folder : "/var/tmp");
  } catch (const std::system_error& error) {
    throw std::runtime_error(std::string("no place for what is sent: ") + error.what() +
                             "; name one with --store FILE, or a folder with TMPDIR");
  }
}

/// Whether another event begins behind `place`: then what is there was not left by an interrupted
/// write, and must not be cut off.
bool has_event_behind(const fs::path& path, std::int64_t place) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(place + 1);
  std::uint32_t word = 0;
  for (char byte = 0; file.get(byte);) {
    word = word << 8U | static_cast<std::uint8_t>(byte);
    if (word == log_format::kSyncWord) return true;
  }
  return false;
}

}  // namespace

LogFiles::LogFiles(const fs::path& path, std::int64_t max_file_bytes)
    : path_(path),
      max_file_bytes_(path.empty() ? std::numeric_limits<std::int64_t>::max() : max_file_bytes) {
  files_.push_back(path.empty() ? create_unnamed() : create_named(path));
}

LogFiles::LogFiles(const fs::path& path, std::int64_t max_file_bytes, const OnEvent& on_event)
    : path_(path), max_file_bytes_(max_file_bytes) {
  open_files();
  read_events(on_event);
}

void LogFiles::open_files() {
  const int last = last_number(path_);
  for (int number = 0; number <= last; ++number) {
    const fs::path file = numbered(path_, number);
    std::error_code ignored;
    if (last > 0 && !fs::exists(file, ignored)) {
      throw std::runtime_error("log '" + file.string() + "' is missing, '" +
                               numbered(path_, last).string() + "' is there");
    }
    files_.push_back(LogWriter::open(file));
  }
}

void LogFiles::read_events(const OnEvent& on_event) {
  for (std::size_t i = 0; i < files_.size(); ++i) {
    LogWriter& file = files_[i];
    if (file.size_bytes() == 0) continue;  // killed before the first event
    LogReader reader(file.path());
    std::int64_t num_events = 0;
    while (const auto event = reader.next()) {
      const auto size = static_cast<std::int32_t>(event->data.size());
      try {
        on_event(*event, {static_cast<std::int32_t>(i), size, reader.bytes_read() - size});
      } catch (const std::exception& error) {
        throw std::runtime_error("log '" + file.path().string() + "', event " +
                                 std::to_string(event->index) + " that ends at byte " +
                                 std::to_string(reader.bytes_read()) + ": " + error.what());
      }
      ++num_events;
    }
    const std::int64_t rest = file.size_bytes() - reader.bytes_read();
    if (rest > 0) {
      const bool is_half_written = i + 1 == files_.size() && reader.is_cut_off() &&
                                   rest < kMaxEventBytes &&
                                   !has_event_behind(file.path(), reader.bytes_read());
      if (!is_half_written) throw std::runtime_error(*reader.damage());
      cut_off_ = "log '" + file.path().string() + "': a half-written event of " +
                 std::to_string(rest) + " bytes at byte " + std::to_string(reader.bytes_read()) +
                 " was cut off";
    }
    if (i + 1 == files_.size()) file.continue_after(reader.bytes_read(), num_events);
  }
}

bool LogFiles::last_file_is_full(std::size_t event_bytes) const {
  const std::int64_t size = files_.back().size_bytes();
  return size > 0 && size + static_cast<std::int64_t>(event_bytes) > max_file_bytes_;
}

LogPlace LogFiles::append(std::int64_t utime, const std::string& channel, ByteView data) {
  const auto overhead = static_cast<std::size_t>(log_format::kEventHeaderBytes) + channel.size();
  if (last_file_is_full(overhead + data.size())) {
    files_.push_back(LogWriter::create(numbered(path_, static_cast<int>(files_.size()))));
  }
  const std::int64_t offset = files_.back().append(utime, channel, data);
  return {static_cast<std::int32_t>(files_.size() - 1), static_cast<std::int32_t>(data.size()),
          offset};
}

const LogWriter& LogFiles::file_of(const LogPlace& place) const {
  return files_.at(static_cast<std::size_t>(place.file));
}

std::int64_t LogFiles::size_bytes() const {
  std::int64_t bytes = 0;
  for (const LogWriter& file : files_) bytes += file.size_bytes();
  return bytes;
}

}  // namespace kintsugi::mapper
