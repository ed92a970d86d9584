#include "mapper/session/log_files.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <ranges>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "lcmtypes/base/file_sync.hpp"
#include "lcmtypes/log/log_format.hpp"
#include "lcmtypes/log/session_log.hpp"
#include "mapper/session/log_marks.hpp"
#include "mapper/session/log_names.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

/// What the mapper writes is smaller: more than this was not left by an interrupted write.
constexpr std::int64_t kMaxEventBytes = 262'144;

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

LogPart part(std::int32_t number, LogWriter file) {
  return {number, std::make_shared<LogWriter>(std::move(file))};
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
  last_ = part(
      0, config_.path.empty() ? create_unnamed() : create_named(config_.path, config_.durable));
}

LogFiles::LogFiles(Config config, const OnEvent& on_event) : config_(std::move(config)) {
  open_files();
  for (const LogPart& part : all()) {
    if (part.file->size_bytes() > 0) read_file(part, on_event);  // else killed before an event
  }
  if (config_.durable) sync_all();
  remove_left(config_.path, next_after_base(config_.path));
}

void LogFiles::open_files() {
  const std::vector<int> numbers = numbers_of_files(config_.path);
  last_ = part(0, LogWriter::open(config_.path));
  next_number_ = next_after_base(config_.path);
  for (const int number : numbers | std::views::drop(1)) {
    continue_in(LogWriter::open(numbered(config_.path, number)));
  }
}

std::vector<LogPart> LogFiles::all() const {
  std::vector<LogPart> parts = closed_;
  parts.push_back(last_);
  return parts;
}

void LogFiles::read_file(const LogPart& part, const OnEvent& on_event) {
  LogWriter& file = *part.file;
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
      } else if (event->channel != kBaseChannel) {
        on_event(*event, {part.number, size, reader.bytes_read() - size});
      }
      whole = {reader.bytes_read(), whole.events + 1};
    }
    damage = reader.damage().value_or("");
  } catch (const std::exception& error) {
    damage = "log '" + file.path().string() + "', event " + std::to_string(whole.events) +
             " that ends at byte " + std::to_string(reader.bytes_read()) + ": " + error.what();
  }
  const bool is_last = part.number == last_.number;
  if (!damage.empty()) {
    const auto text = text_of_cut(file, whole.bytes, reader.is_cut_off(), has_mark);
    if (!is_last || !text) throw std::runtime_error(damage);
    cut_off_ = *text;
  }
  if (is_last) file.continue_after(whole);
}

void LogFiles::sync_all() {
  for (const LogPart& part : all()) part.file->sync();
  sync_folder(config_.path.parent_path());
}

std::int64_t LogFiles::event_bytes(const std::string& channel, ByteView data) {
  return log_format::kEventHeaderBytes + std::ssize(channel) + std::ssize(data);
}

bool LogFiles::has_room(std::int64_t bytes) const {
  return last_.file->size_bytes() + bytes <= config_.max_file_bytes;
}

bool LogFiles::takes(std::int64_t event_bytes) const {
  return last_.file->size_bytes() == 0 || has_room(event_bytes);
}

LogWriter LogFiles::create_next() const {
  if (config_.path.empty()) return create_unnamed();
  const fs::path path = numbered(config_.path, next_number_);
  return config_.durable ? LogWriter::create_anew(partial(path)) : LogWriter::create(path);
}

void LogFiles::continue_in(LogWriter next) {
  closed_.push_back(std::exchange(last_, part(next_number_, std::move(next))));
  ++next_number_;
}

LogWriter LogFiles::create_base() const {
  return config_.path.empty() ? create_unnamed()
                              : LogWriter::create_anew(base_in_work(config_.path));
}

void LogFiles::remove_base() const {
  std::error_code ignored;  // then it is left until the log is opened again
  if (!config_.path.empty()) fs::remove(base_in_work(config_.path), ignored);
}

void LogFiles::install(LogWriter& base) const {
  if (config_.path.empty()) return;
  // Always: what it replaces is removed next, and perhaps sooner from the disk than this is on it.
  base.sync();
  base.replace(config_.path);
  sync_folder(config_.path.parent_path());
}

void LogFiles::use(std::shared_ptr<LogWriter> base, std::size_t count) {
  const auto first = closed_.begin();
  closed_.erase(first, first + static_cast<std::ptrdiff_t>(count));
  closed_.insert(closed_.begin(), LogPart{0, std::move(base)});
}

void LogFiles::remove(const std::vector<LogPart>& parts) const {
  if (config_.path.empty()) return;
  for (const LogPart& part : parts) {
    std::error_code ignored;  // then it is left until the log is opened again
    if (part.number > 0) fs::remove(numbered(config_.path, part.number), ignored);
  }
}

LogPlace LogFiles::append(std::int64_t utime, const std::string& channel, ByteView data) {
  if (!config_.durable && !takes(event_bytes(channel, data))) continue_in(create_next());
  const std::int64_t offset = last_.file->append(utime, channel, data);
  return {last_.number, static_cast<std::int32_t>(data.size()), offset};
}

void LogFiles::begin_batch(std::int64_t utime) {
  last_.file->append(utime, kMarkChannel, mark_at(last_.file->size_bytes()));
}

void LogFiles::sync() {
  LogWriter& file = *last_.file;
  file.sync();
  const fs::path name = numbered(config_.path, last_.number);
  if (file.path() != name) {
    folder_is_synced_ = false;
    file.rename(name);
  }
  if (!folder_is_synced_) sync_folder(config_.path.parent_path());
  folder_is_synced_ = true;
}

void LogFiles::undo(const LogWriter::End& end) {
  try {
    last_.file->continue_after(end);
  } catch (const std::exception&) {  // what is left is overwritten by the same events
  }
}

void LogFiles::remove() {
  std::error_code ignored;
  if (!config_.path.empty()) fs::remove(last_.file->path(), ignored);
}

std::shared_ptr<const LogWriter> LogFiles::file_of(const LogPlace& place) const {
  if (place.file == last_.number) return last_.file;
  return std::ranges::lower_bound(closed_, place.file, {}, &LogPart::number)->file;
}

std::int64_t LogFiles::size_bytes() const {
  std::int64_t bytes = last_.file->size_bytes();
  for (const LogPart& part : closed_) bytes += part.file->size_bytes();
  return bytes;
}

}  // namespace kintsugi::mapper
