#include "lcmtypes/log/log_reader.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "lcmtypes/log/log_format.hpp"

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

LogReader::LogReader(const std::filesystem::path& path) : path_(path) {
  std::error_code error;
  if (std::filesystem::is_directory(path_, error)) fail(path_, "is a folder, expected an LCM log");
  const auto size = std::filesystem::file_size(path_, error);
  if (error) fail(path_, "cannot be read: " + error.message());
  if (size == 0) fail(path_, "is empty");
  size_ = static_cast<std::int64_t>(size);
  file_.open(path_, std::ios::binary);
  if (!file_) fail(path_, std::string("cannot be opened: ") + std::strerror(errno));
  EventHeader header{};
  if (!read(file_, header) || big_endian(header, 0, 4) != kSyncWord) {
    fail(path_, "is no LCM log: it does not begin with an event");
  }
  file_.seekg(0);
}

std::optional<LogEvent> LogReader::next() {
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
