#include "segmenter/objects/library/library_lock.hpp"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "lcmtypes/base/file_sync.hpp"
#include "segmenter/objects/library/object_files.hpp"

namespace kintsugi::segmenter {

LibraryLock::LibraryLock(const std::filesystem::path& library) {
  make_folder(library);
  descriptor_ = open(library.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) {
    throw std::system_error(errno, std::generic_category(),
                            "cannot open the folder '" + library.string() + "'");
  }
  while (flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
  }
  try {
    bring_back_objects(library);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

LibraryLock::~LibraryLock() { close(descriptor_); }

}  // namespace kintsugi::segmenter
