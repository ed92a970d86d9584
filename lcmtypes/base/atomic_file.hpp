#pragma once
// Output files that are whole or absent.

#include <filesystem>
#include <memory>
#include <ostream>

namespace kintsugi {

/// Writes beside the final name and renames on commit(): under the final name there is the old
/// content or all of the new, whatever happens. Without commit() nothing remains.
///
/// Either write to stream(), which throws std::system_error naming both files and the reason at
/// the write that failed; or have a library write to partial_path(), which keeps the extension.
/// Prefer the stream where the library can write to memory: few libraries report a full disk.
class AtomicFile {
 public:
  /// Nothing is opened yet. Throws std::invalid_argument when `path` has no file name.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The partial file, opened (and emptied) at the first call.
  std::ostream& stream();
  const std::filesystem::path& partial_path() const { return partial_path_; }

  /// Flushes, forces to disk and renames. Throws std::system_error, and nothing remains then.
  void commit();

 private:
  class FileBuffer;

  std::filesystem::path path_;
  std::filesystem::path partial_path_;
  std::unique_ptr<FileBuffer> buffer_;
  std::unique_ptr<std::ostream> stream_;
  bool committed_ = false;
};

}  // namespace kintsugi
