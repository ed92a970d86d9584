#pragma once
// Where a program is to write: checked before it works.

#include <filesystem>
#include <string>
#include <vector>

namespace kintsugi {

/// A file on the command line.
struct NamedFile {
  std::string name;  ///< of the flag or argument
  std::filesystem::path path;
};

/// Whether two paths lead to the same file, by links, other spellings, or as they are.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// What is written takes the place of no other file. Those without a path are not asked for.
/// @throws std::runtime_error naming both, when a file is written twice, or read, too
void check_different(const std::vector<NamedFile>& read, const std::vector<NamedFile>& written);

/// The folder of a file is there, and the file is no folder. An empty path is not asked for.
/// @throws std::runtime_error naming the file
void check_folder_of(const std::filesystem::path& file);

}  // namespace kintsugi
