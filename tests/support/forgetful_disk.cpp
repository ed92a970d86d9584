// A library for LD_PRELOAD: writes down what a program does to the files of one folder, and when it
// syncs them, so that power_cut.cpp can tell what a power cut at any of these moments would have
// left. Nothing is synced really. Datagrams of LCM are written down, too: what others have heard.
//
//   FORGETFUL_DISK=FOLDER        the folder that is watched, an absolute path
//   FORGETFUL_JOURNAL=FILE       where it is written, outside of the folder: FILE.1.1234 and the
//   like,
//                                one for each program that inherits this environment
//   FORGETFUL_SYNC_MS=N          each sync of a file takes so long
//   FORGETFUL_FAIL_SYNCS=A-B     the Ath to Bth sync of a file fails with EIO
//
// Not seen: what stdio of the C library writes, and mmap.

#include <cerrno>
#include <chrono>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <dlfcn.h>
#include <fcntl.h>
#include <linux/fs.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include "tests/support/disk_journal.hpp"

namespace {

using kintsugi::testing::DiskAction;
using kintsugi::testing::DiskRecord;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::int64_t now_us() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1'000;
}

/// A name in a folder that is watched.
struct Place {
  int folder;
  std::string name;
};

class Watch {
 public:
  /// nullptr: no folder is watched, or the program has not begun: a sanitizer that makes the folder
  /// of its log (log_path) can take neither a static variable nor instrumented code then.
  static Watch* instance() { return instance_; }
  static void begin() {
    if (!environment("FORGETFUL_DISK").empty()) instance_ = new Watch;
  }

  std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }

  std::int64_t note(DiskRecord record, std::string_view text = {}) {
    record.time_us = now_us();
    record.text_bytes = static_cast<std::uint32_t>(text.size());
    std::string bytes(reinterpret_cast<const char*>(&record), sizeof record);
    bytes += text;
    syscall(SYS_write, journal_, bytes.data(), bytes.size());
    return num_records_++;
  }

  /// The place of a path, if it is in the watched folder.
  std::optional<Place> place(int directory, const char* path) {
    const std::string text = path;
    const auto slash = text.find_last_of('/', text.find_last_not_of('/'));
    const std::string parent = slash == std::string::npos ? "." : text.substr(0, slash + 1);
    struct stat status {};
    if (fstatat(directory, parent.c_str(), &status, 0) != 0) return {};
    const auto folder = known(status, absolute(directory, parent));
    if (!folder) return {};
    std::string name = slash == std::string::npos ? text : text.substr(slash + 1);
    while (name.ends_with('/')) name.pop_back();
    return Place{*folder, name};
  }

  /// The number of a file or folder that is open.
  std::optional<int> node(int descriptor) {
    struct stat status {};
    if (fstat(descriptor, &status) != 0) return {};
    if (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) return {};
    return known(status, absolute(descriptor, ""));
  }

  int make(const struct stat& status) {
    return nodes_[{status.st_dev, status.st_ino}] = next_node_++;
  }

  void made(int directory, const char* path, const Place& place, DiskAction action) {
    struct stat status {};
    if (fstatat(directory, path, &status, 0) != 0) return;
    note({.node = make(status), .folder = place.folder, .action = action}, place.name);
  }

  int sync_ms() const { return sync_ms_; }
  bool next_sync_fails() {
    ++num_syncs_;
    return num_syncs_ >= first_failure_ && num_syncs_ <= last_failure_;
  }

 private:
  Watch() : root_(environment("FORGETFUL_DISK")) {
    // A program that another one becomes has its number.
    const std::string file = environment("FORGETFUL_JOURNAL") + '.' + std::to_string(getpid()) +
                             '.' + std::to_string(now_us());
    journal_ = static_cast<int>(syscall(SYS_openat, AT_FDCWD, file.c_str(),
                                        O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    struct stat status {};
    if (journal_ < 0 || stat(root_.c_str(), &status) != 0) std::abort();
    nodes_[{status.st_dev, status.st_ino}] = 0;
    sync_ms_ = number_at(environment("FORGETFUL_SYNC_MS").c_str(), nullptr);
    const std::string failures = environment("FORGETFUL_FAIL_SYNCS");  // FIRST-LAST
    if (failures.empty()) return;
    char* dash = nullptr;
    first_failure_ = number_at(failures.c_str(), &dash);
    last_failure_ = *dash == '-' ? number_at(dash + 1, nullptr) : first_failure_;
  }

  static int number_at(const char* text, char** end) {
    return static_cast<int>(std::strtol(text, end, 10));
  }

  /// The path of an open file or of a path below it.
  static std::string absolute(int directory, const std::string& path) {
    if (path.starts_with('/')) return path;
    const std::string link =
        directory == AT_FDCWD ? "/proc/self/cwd" : "/proc/self/fd/" + std::to_string(directory);
    char target[4096];
    const ssize_t bytes = readlink(link.c_str(), target, sizeof target);
    return std::string(target, bytes < 0 ? 0 : static_cast<std::size_t>(bytes)) +
           (path.empty() ? "" : "/" + path);
  }

  /// The number of what has this status and path; nothing: it is not in the watched folder.
  std::optional<int> known(const struct stat& status, std::string path) {
    const auto found = nodes_.find({status.st_dev, status.st_ino});
    if (found != nodes_.end()) return found->second;
    if (!path.starts_with(root_ + "/")) return {};
    path.erase(0, root_.size() + 1);
    while (path.ends_with('/')) path.pop_back();
    const int node = make(status);
    note({.node = node, .action = DiskAction::kFound}, path);
    return node;
  }

  static inline Watch* instance_ = nullptr;

  std::mutex mutex_;
  const std::string root_;
  int journal_ = -1;
  std::int64_t num_records_ = 0;
  std::map<std::pair<dev_t, ino_t>, int> nodes_;
  int next_node_ = 1;
  int sync_ms_ = 0;
  int num_syncs_ = 0;
  int first_failure_ = 0;
  int last_failure_ = -1;
};

[[gnu::constructor]] void begin_to_watch() { Watch::begin(); }

int open_watched(int directory, const char* path, int flags, mode_t mode) {
  Watch* const watch = Watch::instance();
  const auto really_open = [&] {
    return static_cast<int>(syscall(SYS_openat, directory, path, flags, mode));
  };
  const bool may_change = (flags & (O_CREAT | O_TRUNC)) != 0 && (flags & O_TMPFILE) != O_TMPFILE;
  if (watch == nullptr || !may_change) return really_open();
  const auto lock = watch->lock();
  const auto place = watch->place(directory, path);
  struct stat status {};
  const bool was_there = fstatat(directory, path, &status, 0) == 0;
  const int descriptor = really_open();
  if (descriptor < 0 || !place) return descriptor;
  if (!was_there) {
    watch->made(directory, path, *place, DiskAction::kMadeFile);
  } else if ((flags & O_TRUNC) != 0) {
    if (const auto node = watch->node(descriptor)) {
      watch->note({.node = *node, .action = DiskAction::kShortened});
    }
  }
  return descriptor;
}

ssize_t write_watched(int descriptor, const iovec* parts, int num_parts, off_t offset) {
  const auto really_write = [&]() -> ssize_t {
    if (offset < 0) return syscall(SYS_writev, descriptor, parts, num_parts);
    return syscall(SYS_pwrite64, descriptor, parts->iov_base, parts->iov_len, offset);
  };
  Watch* const watch = Watch::instance();
  if (watch == nullptr) return really_write();
  const auto lock = watch->lock();
  const auto node = watch->node(descriptor);
  if (!node) return really_write();
  if (offset < 0) {
    const bool appends = (fcntl(descriptor, F_GETFL) & O_APPEND) != 0;
    offset = appends ? lseek(descriptor, 0, SEEK_END) : lseek(descriptor, 0, SEEK_CUR);
    const ssize_t written = syscall(SYS_writev, descriptor, parts, num_parts);
    std::string text;
    for (int i = 0; i < num_parts; ++i) {
      text.append(static_cast<const char*>(parts[i].iov_base), parts[i].iov_len);
    }
    if (written > 0) {
      text.resize(static_cast<std::size_t>(written));
      watch->note({.offset = offset, .node = *node, .action = DiskAction::kWritten}, text);
    }
    return written;
  }
  const ssize_t written = really_write();
  if (written > 0) {
    watch->note({.offset = offset, .node = *node, .action = DiskAction::kWritten},
                {static_cast<const char*>(parts->iov_base), static_cast<std::size_t>(written)});
  }
  return written;
}

int shorten_watched(int descriptor, off_t size) {
  Watch* const watch = Watch::instance();
  std::unique_lock<std::mutex> lock;
  if (watch != nullptr) lock = watch->lock();
  const int result = static_cast<int>(syscall(SYS_ftruncate, descriptor, size));
  if (watch == nullptr || result != 0) return result;
  if (const auto node = watch->node(descriptor)) {
    watch->note({.offset = size, .node = *node, .action = DiskAction::kShortened});
  }
  return result;
}

int sync_watched(int descriptor, long number) {
  Watch* const watch = Watch::instance();
  if (watch == nullptr) return static_cast<int>(syscall(number, descriptor));
  auto lock = watch->lock();
  const auto node = watch->node(descriptor);
  if (!node) return static_cast<int>(syscall(number, descriptor));
  struct stat status {};
  const bool is_file = fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  const std::int64_t begun = watch->note({.node = *node, .action = DiskAction::kSyncBegun});
  const bool fails = is_file && watch->next_sync_fails();
  lock.unlock();
  if (is_file && watch->sync_ms() > 0) usleep(static_cast<useconds_t>(1'000 * watch->sync_ms()));
  lock.lock();
  const DiskAction end = fails ? DiskAction::kSyncFailed : DiskAction::kSyncDone;
  watch->note({.offset = begun, .node = *node, .action = end});
  if (!fails) return 0;
  errno = EIO;
  return -1;
}

int rename_watched(int from_directory, const char* from, int to_directory, const char* to,
                   unsigned flags) {
  Watch* const watch = Watch::instance();
  std::unique_lock<std::mutex> lock;
  std::optional<Place> from_place;
  std::optional<Place> to_place;
  if (watch != nullptr) {
    lock = watch->lock();
    from_place = watch->place(from_directory, from);
    to_place = watch->place(to_directory, to);
  }
  const int result =
      static_cast<int>(syscall(SYS_renameat2, from_directory, from, to_directory, to, flags));
  if (result != 0 || !from_place || !to_place) return result;
  const bool exchanges = (flags & RENAME_EXCHANGE) != 0;
  watch->note({.folder = from_place->folder,
               .to_folder = to_place->folder,
               .action = exchanges ? DiskAction::kExchanged : DiskAction::kRenamed},
              from_place->name + '\0' + to_place->name);
  return result;
}

int remove_watched(int directory, const char* path, int flags) {
  Watch* const watch = Watch::instance();
  std::unique_lock<std::mutex> lock;
  std::optional<Place> place;
  if (watch != nullptr) {
    lock = watch->lock();
    place = watch->place(directory, path);
  }
  const int result = static_cast<int>(syscall(SYS_unlinkat, directory, path, flags));
  if (result == 0 && place) {
    watch->note({.folder = place->folder, .action = DiskAction::kRemoved}, place->name);
  }
  return result;
}

FILE* open_stream_watched(const char* function, const char* path, const char* mode) {
  using Open = FILE* (*)(const char*, const char*);
  const auto really_open = reinterpret_cast<Open>(dlsym(RTLD_NEXT, function));
  if (*mode != 'r') {
    // Makes or empties it as open() does; the stream finds it so.
    const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (*mode == 'w' ? O_TRUNC : 0);
    const int descriptor = open_watched(AT_FDCWD, path, flags, 0666);
    if (descriptor < 0) return nullptr;
    syscall(SYS_close, descriptor);
  }
  return really_open(path, mode);
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const auto mode = static_cast<mode_t>(va_arg(arguments, int));
  va_end(arguments);
  return open_watched(AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const auto mode = static_cast<mode_t>(va_arg(arguments, int));
  va_end(arguments);
  return open_watched(AT_FDCWD, path, flags, mode);
}
FILE* fopen(const char* path, const char* mode) { return open_stream_watched("fopen", path, mode); }
FILE* fopen64(const char* path, const char* mode) {
  return open_stream_watched("fopen64", path, mode);
}

ssize_t write(int descriptor, const void* data, size_t bytes) {
  const iovec part{const_cast<void*>(data), bytes};
  return write_watched(descriptor, &part, 1, -1);
}
ssize_t writev(int descriptor, const iovec* parts, int num_parts) {
  return write_watched(descriptor, parts, num_parts, -1);
}
ssize_t pwrite(int descriptor, const void* data, size_t bytes, off_t offset) {
  const iovec part{const_cast<void*>(data), bytes};
  return write_watched(descriptor, &part, 1, offset);
}
ssize_t pwrite64(int descriptor, const void* data, size_t bytes, off64_t offset) {
  return pwrite(descriptor, data, bytes, offset);
}

int ftruncate(int descriptor, off_t size) noexcept { return shorten_watched(descriptor, size); }
int ftruncate64(int descriptor, off64_t size) noexcept { return shorten_watched(descriptor, size); }

int fsync(int descriptor) { return sync_watched(descriptor, SYS_fsync); }
int fdatasync(int descriptor) { return sync_watched(descriptor, SYS_fdatasync); }

int rename(const char* from, const char* to) noexcept {
  return rename_watched(AT_FDCWD, from, AT_FDCWD, to, 0);
}
int renameat2(int from_directory, const char* from, int to_directory, const char* to,
              unsigned flags) noexcept {
  return rename_watched(from_directory, from, to_directory, to, flags);
}

int unlink(const char* path) noexcept { return remove_watched(AT_FDCWD, path, 0); }
int rmdir(const char* path) noexcept { return remove_watched(AT_FDCWD, path, AT_REMOVEDIR); }
int unlinkat(int directory, const char* path, int flags) noexcept {
  return remove_watched(directory, path, flags);
}
int remove(const char* path) noexcept {
  if (unlink(path) == 0) return 0;
  return errno == EISDIR ? rmdir(path) : -1;
}

int mkdir(const char* path, mode_t mode) noexcept {
  Watch* const watch = Watch::instance();
  if (watch == nullptr) return static_cast<int>(syscall(SYS_mkdir, path, mode));
  const auto lock = watch->lock();
  const auto place = watch->place(AT_FDCWD, path);
  const int result = static_cast<int>(syscall(SYS_mkdir, path, mode));
  if (result == 0 && place) watch->made(AT_FDCWD, path, *place, DiskAction::kMadeFolder);
  return result;
}

ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  if (Watch* const watch = Watch::instance()) {
    std::string datagram;
    for (std::size_t i = 0; i < message->msg_iovlen; ++i) {
      datagram.append(static_cast<const char*>(message->msg_iov[i].iov_base),
                      message->msg_iov[i].iov_len);
    }
    const auto lock = watch->lock();
    if (datagram.starts_with("LC02")) watch->note({.action = DiskAction::kSent}, datagram);
  }
  return syscall(SYS_sendmsg, socket, message, flags);
}

}  // extern "C"
