#pragma once

#include <filesystem>

namespace kintsugi::segmenter {

/// Held while a program reads objects of a library in order to change them: of several, one at a
/// time does. Who only reads needs none. Where the file system has no locks, it locks nothing.
class LibraryLock {
 public:
  /// Waits for its turn. Makes the folder when it is absent, and mends what a program has left that
  /// was killed (bring_back_objects()).
  /// @throws std::system_error naming a folder that cannot be made, opened or mended
  explicit LibraryLock(const std::filesystem::path& library);
  ~LibraryLock();
  LibraryLock(const LibraryLock&) = delete;
  LibraryLock& operator=(const LibraryLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace kintsugi::segmenter
