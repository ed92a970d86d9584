#pragma once
// Output files that are never incomplete.

#include <filesystem>
#include <memory>
#include <ostream>

namespace kintsugi {

/// Writes to a second name and renames on commit(): whatever happens, the file with the final name
/// has either its old content or all of the new. Without commit() the second file is removed.
///
/// Either write to stream(), which throws std::system_error with both names and the reason at the
/// write that fails; or let a library write to partial_path(), which has the same extension. Prefer
/// the stream if the library can write to memory: few libraries report a full disk.
class AtomicFile {
 public:
  /// Opens nothing yet. Links are followed. @throws std::invalid_argument when `path` has no file
  /// name, or is a device or a pipe
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The second file, opened and emptied at the first call.
  std::ostream& stream();
  const std::filesystem::path& partial_path() const { return partial_path_; }

  /// Writes everything to disk and renames. @throws std::system_error; then no new file remains
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
