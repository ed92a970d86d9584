#include "mapper/session/log_files.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "lcmtypes/base/file_sync.hpp"
#include "lcmtypes/log/log_format.hpp"
#include "mapper/session/log_marks.hpp"

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

/// NAME.partial.lcm, as AtomicFile names files.
fs::path partial(const fs::path& path) {
  return path.parent_path() / (path.stem().string() + ".partial" + path.extension().string());
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

LogWriter create_named(const fs::path& path, bool durable) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) {
    throw std::runtime_error("log '" + path.string() +
                             "' exists: continue it with --resume, or give --store another name");
  }
  if (const int number = last_number(path); number > 0) {
    throw std::runtime_error("log '" + numbered(path, number).string() +
                             "' of an earlier run exists: remove it, or give --store another name");
  }
  return durable ? LogWriter::create_anew(partial(path)) : LogWriter::create(path);
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

/// What is said when the end of a log from byte `end` on is cut off; nothing: neither an
/// interrupted write nor a power cut has left it, so it must not be.
std::optional<std::string> text_of_cut(const LogWriter& file, std::int64_t end, bool is_too_short,
                                       bool has_mark) {
  const std::int64_t rest = file.size_bytes() - end;
  const std::string at = std::to_string(rest) + " bytes at byte " + std::to_string(end);
  const std::string name = "log '" + file.path().string() + "': ";
  if (is_too_short && rest < kMaxEventBytes && !has_event_behind(file.path(), end)) {
    return name + "a half-written event of " + at + " was cut off";
  }
  if (has_mark && !has_mark_behind(file.path(), end)) {
    return name + "what a power cut has left of the last events, " + at + ", was cut off";
  }
  return {};
}

}  // namespace

LogFiles::LogFiles(Config config) : config_(std::move(config)) {
  files_.push_back(config_.path.empty() ? create_unnamed()
                                        : create_named(config_.path, config_.durable));
}

LogFiles::LogFiles(Config config, const OnEvent& on_event) : config_(std::move(config)) {
  open_files();
  for (std::size_t i = 0; i < files_.size(); ++i) {
    if (files_[i].size_bytes() > 0) read_file(i, on_event);  // else killed before the first event
  }
  if (config_.durable) sync_all();
}

void LogFiles::open_files() {
  const int last = last_number(config_.path);
  for (int number = 0; number <= last; ++number) {
    const fs::path file = numbered(config_.path, number);
    std::error_code ignored;
    if (last > 0 && !fs::exists(file, ignored)) {
      throw std::runtime_error("log '" + file.string() + "' is missing, '" +
                               numbered(config_.path, last).string() + "' is there");
    }
    files_.push_back(LogWriter::open(file));
  }
}

void LogFiles::read_file(std::size_t number, const OnEvent& on_event) {
  LogWriter& file = files_[number];
  // What is on the disk of the mapper is not signed; only what it sends is.
  LogReader reader(file.path(), MessageTrust{});
  LogWriter::End whole;  // the events so far
  bool has_mark = false;
  std::string damage;
  try {
    while (const auto event = reader.next()) {
      const auto size = static_cast<std::int32_t>(event->data.size());
      if (event->channel == kMarkChannel) {
        check_mark(*event, whole.bytes);
        has_mark = true;
      } else {
        on_event(*event, {static_cast<std::int32_t>(number), size, reader.bytes_read() - size});
      }
      whole = {reader.bytes_read(), whole.events + 1};
    }
    damage = reader.damage().value_or("");
  } catch (const std::exception& error) {
    damage = "log '" + file.path().string() + "', event " + std::to_string(whole.events) +
             " that ends at byte " + std::to_string(reader.bytes_read()) + ": " + error.what();
  }
  const bool is_last = number + 1 == files_.size();
  if (!damage.empty()) {
    const auto text = text_of_cut(file, whole.bytes, reader.is_cut_off(), has_mark);
    if (!is_last || !text) throw std::runtime_error(damage);
    cut_off_ = *text;
  }
  if (is_last) file.continue_after(whole);
}

void LogFiles::sync_all() {
  for (LogWriter& file : files_) file.sync();
  sync_folder(config_.path.parent_path());
}

std::int64_t LogFiles::event_bytes(const std::string& channel, ByteView data) {
  return log_format::kEventHeaderBytes + std::ssize(channel) + std::ssize(data);
}

bool LogFiles::has_room(std::int64_t bytes) const {
  const std::int64_t size = files_.back().size_bytes();
  return config_.path.empty() || size == 0 || size + bytes <= config_.max_file_bytes;
}

LogWriter LogFiles::create_next() const {
  const fs::path path = numbered(config_.path, static_cast<int>(files_.size()));
  return config_.durable ? LogWriter::create_anew(partial(path)) : LogWriter::create(path);
}

LogPlace LogFiles::append(std::int64_t utime, const std::string& channel, ByteView data) {
  if (!config_.durable && !has_room(event_bytes(channel, data))) continue_in(create_next());
  const std::int64_t offset = files_.back().append(utime, channel, data);
  return {static_cast<std::int32_t>(files_.size() - 1), static_cast<std::int32_t>(data.size()),
          offset};
}

void LogFiles::begin_batch(std::int64_t utime) {
  LogWriter& file = files_.back();
  file.append(utime, kMarkChannel, mark_at(file.size_bytes()));
}

void LogFiles::sync() {
  LogWriter& file = files_.back();
  file.sync();
  const fs::path name = numbered(config_.path, static_cast<int>(files_.size() - 1));
  if (file.path() != name) {
    folder_is_synced_ = false;
    file.rename(name);
  }
  if (!folder_is_synced_) sync_folder(config_.path.parent_path());
  folder_is_synced_ = true;
}

void LogFiles::undo(const LogWriter::End& end) {
  try {
    files_.back().continue_after(end);
  } catch (const std::exception&) {  // what is left is overwritten by the same events
  }
}

void LogFiles::remove() {
  std::error_code ignored;
  if (!config_.path.empty()) fs::remove(files_.back().path(), ignored);
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
