#pragma once
// A small file system, for tests of a full disk.

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <sched.h>
#include <sys/mount.h>

namespace kintsugi::testing {

/// A tmpfs on a folder, in a mount namespace of the test: only its children see it.
class SmallDisk {
 public:
  explicit SmallDisk(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~SmallDisk() {
    if (is_mounted_) umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  /// Mounts it on the folder, which is created if it does not exist. `size` in the format of tmpfs
  /// ("64k").
  /// Call before the process has a second thread. Returns why it is not permitted here, if so:
  ///   if (const auto why_not = disk.mount("64k")) GTEST_SKIP() << *why_not;
  std::optional<std::string> mount(const std::string& size) {
    std::filesystem::create_directories(folder_);
    is_mounted_ = unshare(CLONE_NEWNS) == 0 &&
                  ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                  mount_tmpfs(0, size);
    if (is_mounted_) return std::nullopt;
    return std::string("no file system of the test's own here: ") + std::strerror(errno);
  }

  bool resize(const std::string& size) const { return mount_tmpfs(MS_REMOUNT, size); }

  bool forbid_writing() const {
    return ::mount("tmpfs", folder_.c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, "") == 0;
  }

  const std::filesystem::path& folder() const { return folder_; }

 private:
  bool mount_tmpfs(unsigned long flags, const std::string& size) const {
    return ::mount("tmpfs", folder_.c_str(), "tmpfs", flags, ("size=" + size).c_str()) == 0;
  }

  std::filesystem::path folder_;
  bool is_mounted_ = false;
};

}  // namespace kintsugi::testing
