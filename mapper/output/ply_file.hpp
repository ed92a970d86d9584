#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lcmtypes/base/atomic_file.hpp"

namespace kintsugi::mapper {

/// A list in a PLY file.
struct PlyElement {
  std::string name;                     ///< "vertex", "face"
  std::vector<std::string> properties;  ///< "float x", "list uchar int vertex_indices"
};

/// Writes a binary little-endian PLY file piece by piece; how long its lists will be is known only
/// in the end. Takes no memory: the lists wait in files beside the last one.
///
/// Under the final name there is nothing new before commit(), and without it nothing remains.
class PlyFile {
 public:
  /// Each of `comments` becomes a line of the header.
  /// @throws std::invalid_argument when `path` has no file name, or a comment has several lines
  PlyFile(const std::filesystem::path& path, std::vector<PlyElement> elements,
          std::vector<std::string> comments = {});
  ~PlyFile();

  /// Appends `count` records, packed as the properties say, to list `element`.
  /// @throws std::system_error naming the file and the reason
  void append(std::size_t element, std::span<const std::byte> records, std::int64_t count);

  /// Writes the whole file; nothing can be appended then.
  /// @throws std::system_error naming the file and the reason
  void commit();

 private:
  struct List;

  std::filesystem::path path_;
  std::vector<std::string> comments_;
  std::vector<std::unique_ptr<List>> lists_;
};

}  // namespace kintsugi::mapper
