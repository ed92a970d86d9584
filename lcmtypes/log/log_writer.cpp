#include "lcmtypes/log/log_writer.hpp"

#include <array>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "lcmtypes/base/file_sync.hpp"
#include "lcmtypes/log/log_format.hpp"

namespace kintsugi {
namespace {

[[noreturn]] void fail(const char* what, const std::filesystem::path& path, int error) {
  throw std::system_error(error, std::generic_category(),
                          std::string("cannot ") + what + " log '" + path.string() + "'");
}

void put_big_endian(Bytes& bytes, std::uint64_t value, std::size_t num_bytes) {
  for (std::size_t i = num_bytes; i-- > 0;) {
    bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
}

Bytes encode_event(std::int64_t number, std::int64_t utime, const std::string& channel,
                   ByteView data) {
  Bytes event;
  event.reserve(static_cast<std::size_t>(log_format::kEventHeaderBytes) + channel.size() +
                data.size());
  put_big_endian(event, log_format::kSyncWord, 4);
  put_big_endian(event, static_cast<std::uint64_t>(number), 8);
  put_big_endian(event, static_cast<std::uint64_t>(utime), 8);
  put_big_endian(event, channel.size(), 4);
  put_big_endian(event, data.size(), 4);
  event.insert(event.end(), channel.begin(), channel.end());
  event.insert(event.end(), data.begin(), data.end());
  return event;
}

/// 0, or why not all of `bytes` could be written.
int write_all(int descriptor, ByteView bytes, std::int64_t place) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(descriptor, bytes.data(), bytes.size(), place);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    place += written;
  }
  return 0;
}

}  // namespace

LogWriter LogWriter::create(const std::filesystem::path& path) { return {path, O_CREAT | O_EXCL}; }

LogWriter LogWriter::create_anew(const std::filesystem::path& path) {
  LogWriter log(path, O_CREAT);
  log.continue_after({});
  return log;
}

LogWriter LogWriter::open(const std::filesystem::path& path) { return {path, 0}; }

LogWriter LogWriter::temporary(const std::filesystem::path& folder) { return {folder, O_TMPFILE}; }

LogWriter::LogWriter(std::filesystem::path path, int flags)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_RDWR | O_CLOEXEC | flags, 0666)) {
  if (descriptor_ < 0) fail(flags == 0 ? "open" : "create", path_, errno);
  const bool is_locked = flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
  const std::int64_t size = is_locked ? lseek(descriptor_, 0, SEEK_END) : -1;
  if (size < 0) {
    const int error = errno;
    close(descriptor_);
    fail(error == EWOULDBLOCK ? "lock, because another process writes it, the" : "open", path_,
         error);
  }
  size_ = size;
}

LogWriter::~LogWriter() {
  if (descriptor_ >= 0) close(descriptor_);
}

LogWriter::LogWriter(LogWriter&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      num_events_(other.num_events_) {}

void LogWriter::continue_after(const End& end) {
  const bool is_longer = end.bytes < size_;
  size_ = end.bytes;
  num_events_ = end.events;
  if (is_longer && ftruncate(descriptor_, end.bytes) != 0) fail("shorten", path_, errno);
}

std::int64_t LogWriter::append(std::int64_t utime, const std::string& channel, ByteView data) {
  assert(!channel.empty() &&
         channel.size() <= static_cast<std::size_t>(log_format::kMaxChannelBytes));
  const Bytes event = encode_event(num_events_, utime, channel, data);
  if (const int error = write_all(descriptor_, event, size_)) {
    // If this fails, too, the next event overwrites the rest.
    [[maybe_unused]] const int ignored = ftruncate(descriptor_, size_);
    fail("write", path_, error);
  }
  size_ += static_cast<std::int64_t>(event.size());
  ++num_events_;
  return size_ - static_cast<std::int64_t>(data.size());
}

void LogWriter::sync() { sync_file(descriptor_, "log '" + path_.string() + "'"); }

void LogWriter::rename(const std::filesystem::path& path) {
  int result = renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE);
  if (result != 0 && (errno == EINVAL || errno == ENOSYS)) {  // a file system without it
    result = std::rename(path_.c_str(), path.c_str());
  }
  if (result != 0) fail("rename to", path, errno);
  path_ = path;
}

void LogWriter::replace(const std::filesystem::path& path) {
  if (std::rename(path_.c_str(), path.c_str()) != 0) fail("rename to", path, errno);
  path_ = path;
}

std::filesystem::path LogWriter::open_path() const {
  return "/proc/self/fd/" + std::to_string(descriptor_);
}

Bytes LogWriter::read(std::int64_t place, std::size_t size) const {
  Bytes data(size);
  for (std::size_t done = 0; done < size;) {
    const ssize_t got = pread(descriptor_, data.data() + done, size - done,
                              place + static_cast<std::int64_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("read", path_, errno);
    if (got == 0) {
      throw std::runtime_error("log '" + path_.string() + "' has become shorter: expected " +
                               std::to_string(size) + " bytes at " + std::to_string(place));
    }
    done += static_cast<std::size_t>(got);
  }
  return data;
}

}  // namespace kintsugi
