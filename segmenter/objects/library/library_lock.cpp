#include "segmenter/objects/library/library_lock.hpp"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace kintsugi::segmenter {

LibraryLock::LibraryLock(const std::filesystem::path& library) {
  std::error_code error;
  std::filesystem::create_directories(library, error);
  if (error) throw std::system_error(error, "cannot make the folder '" + library.string() + "'");
  descriptor_ = open(library.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) {
    throw std::system_error(errno, std::generic_category(),
                            "cannot open the folder '" + library.string() + "'");
  }
  while (flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

LibraryLock::~LibraryLock() { close(descriptor_); }

}  // namespace kintsugi::segmenter
