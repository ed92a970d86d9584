#include "lcmtypes/log/log_reader.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "lcmtypes/log/log_format.hpp"
#include "lcmtypes/signing/process_key.hpp"

namespace kintsugi {
namespace {

using log_format::kEventHeaderBytes;
using log_format::kMaxChannelBytes;
using log_format::kSyncWord;
using EventHeader = std::array<std::uint8_t, kEventHeaderBytes>;

std::uint64_t big_endian(const EventHeader& bytes, std::size_t place, std::size_t num_bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < num_bytes; ++i) value = value << 8U | bytes.at(place + i);
  return value;
}

template <class Bytes>
bool read(std::ifstream& file, Bytes& bytes) {
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return file.good();
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw std::runtime_error("log '" + path.string() + "' " + what);
}

}  // namespace

LogReader::LogReader(const std::filesystem::path& path) : LogReader(path, log_trust()) {}

LogReader::LogReader(const std::filesystem::path& path, const MessageTrust& trust)
    : path_(path),
      has_key_(trust.key != nullptr),
      guard_(trust, MessageGuard::Source::kLog, path.string()) {
  std::error_code error;
  if (std::filesystem::is_directory(path_, error)) fail(path_, "is a folder, expected an LCM log");
  size_ = size_of_file();
  if (size_ == 0) fail(path_, "is empty");
  file_.open(path_, std::ios::binary);
  if (!file_) fail(path_, std::string("cannot be opened: ") + std::strerror(errno));
  EventHeader header{};
  if (!read(file_, header) || big_endian(header, 0, 4) != kSyncWord) {
    fail(path_, "is no LCM log: it does not begin with an event");
  }
  rewind();
  check_signatures(trust);
}

std::int64_t LogReader::size_of_file() const {
  std::error_code error;
  const auto size = std::filesystem::file_size(path_, error);
  if (error) fail(path_, "cannot be read: " + error.message());
  return static_cast<std::int64_t>(size);
}

/// Throws now what would otherwise be an empty map, or refused by every decoder, much later.
void LogReader::check_signatures(const MessageTrust& trust) {
  if (trust.trusts_all) return;
  std::int64_t num_unsigned = 0;
  std::int64_t num_forged = 0;
  while (const auto event = read_event()) {
    if (!trust.key) (void)guard_.open(event->channel, event->data);
    if (event->channel == log_format::kSelfTestChannel) continue;
    const auto parts = signed_message::split(event->data);
    const bool is_readable =
        !trust.key || (parts && signed_message::is_genuine(*trust.key, event->channel, *parts));
    if (is_readable) return rewind();
    ++(parts ? num_forged : num_unsigned);
  }
  if (num_unsigned + num_forged > 0) {
    fail(path_, "has no message that is signed with the key of --bus-key: " +
                    std::to_string(num_unsigned) + " are not signed, " +
                    std::to_string(num_forged) +
                    " are signed otherwise; --trust-log reads it without verification");
  }
  rewind();
}

/// Back to the first event.
void LogReader::rewind() {
  file_.clear();
  file_.seekg(0);
  position_ = 0;
  index_ = 0;
  damage_.reset();
  is_cut_off_ = false;
}

std::optional<LogEvent> LogReader::next() {
  while (auto event = read_event()) {
    if (has_key_ && event->channel == log_format::kSelfTestChannel) continue;
    if (const auto message = guard_.open(event->channel, event->data)) {
      event->data = *message;
      return event;
    }
  }
  return {};
}

void LogReader::go_on() {
  size_ = size_of_file();
  if (is_cut_off_) {
    damage_.reset();
    is_cut_off_ = false;
  }
  file_.clear();
  file_.seekg(position_);
}

/// The next event as it is in the file.
std::optional<LogEvent> LogReader::read_event() {
  if (damage_ || position_ == size_) return {};
  EventHeader header{};
  if (!read(file_, header)) {
    is_cut_off_ = true;
    return stop("cut off in an event's header");
  }
  if (big_endian(header, 0, 4) != kSyncWord) return stop("expected the sync word of an event");
  const auto channel_bytes = static_cast<std::int32_t>(big_endian(header, 20, 4));
  const auto data_bytes = static_cast<std::int32_t>(big_endian(header, 24, 4));
  if (channel_bytes < 1 || channel_bytes > kMaxChannelBytes || data_bytes < 0) {
    return stop("an event with a channel of " + std::to_string(channel_bytes) +
                " bytes and data of " + std::to_string(data_bytes));
  }
  const std::int64_t end = position_ + kEventHeaderBytes + channel_bytes + data_bytes;
  if (end > size_) {
    is_cut_off_ = true;
    return stop("the event lacks its last " + std::to_string(end - size_) + " bytes");
  }

  std::string channel(static_cast<std::size_t>(channel_bytes), '\0');
  data_.resize(static_cast<std::size_t>(data_bytes));
  if (!read(file_, channel) || !read(file_, data_)) return stop(std::strerror(errno));
  position_ = end;
  const auto utime = static_cast<std::int64_t>(big_endian(header, 12, 8));
  return LogEvent{index_++, utime, std::move(channel), data_};
}

/// Keeps the reason why nothing more can be read.
std::nullopt_t LogReader::stop(const std::string& what) {
  damage_ = "log '" + path_.string() + "' is damaged at byte " + std::to_string(position_) +
            " of " + std::to_string(size_) + ", event " + std::to_string(index_) + ": " + what;
  return std::nullopt;
}

}  // namespace kintsugi
