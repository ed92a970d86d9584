#include "lcmtypes/base/file_sync.hpp"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace kintsugi {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what, const std::string& name, int error) {
  throw std::system_error(error, std::generic_category(), "cannot " + what + " " + name);
}

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

}  // namespace

void sync_file(int descriptor, const std::string& name) {
  // EINVAL: the file system cannot sync this. Then nobody can do more.
  if (fsync(descriptor) != 0 && errno != EINVAL) fail("sync", name, errno);
}

void sync_folder(const fs::path& folder) {
  const fs::path path = folder.empty() ? fs::path(".") : folder;
  const int descriptor = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) fail("open", quoted(path), errno);
  try {
    sync_file(descriptor, quoted(path));
  } catch (...) {
    close(descriptor);
    throw;
  }
  close(descriptor);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  if (folder.empty() || fs::is_directory(folder, error)) return;
  const fs::path parent =
      folder.has_filename() ? folder.parent_path() : folder.parent_path().parent_path();
  make_folder(parent);
  fs::create_directory(folder, error);
  if (error) fail("make the folder", quoted(folder), error.value());
  sync_folder(parent);
}

}  // namespace kintsugi
