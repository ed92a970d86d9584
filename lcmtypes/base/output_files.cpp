#include "lcmtypes/base/output_files.hpp"

#include <stdexcept>
#include <system_error>

namespace kintsugi {
namespace {

namespace fs = std::filesystem;

void check_different(const NamedFile& other, const NamedFile& written) {
  if (other.path.empty() || written.path.empty() || !is_same_file(other.path, written.path)) return;
  throw std::runtime_error(written.name + " is " + written.path.string() +
                           ", the same file as that of " + other.name + ": give it another name");
}

}  // namespace

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  // Of a relative path that does not exist the folder would be left out.
  return fs::weakly_canonical(fs::absolute(a), error) ==
         fs::weakly_canonical(fs::absolute(b), error);
}

void check_different(const std::vector<NamedFile>& read, const std::vector<NamedFile>& written) {
  std::vector<NamedFile> others = read;
  for (const NamedFile& file : written) {
    for (const NamedFile& other : others) check_different(other, file);
    others.push_back(file);
  }
}

void check_folder_of(const fs::path& file) {
  const fs::path folder = file.parent_path();
  if (!folder.empty() && !fs::is_directory(folder)) {
    throw std::runtime_error(file.string() + ": there is no folder " + folder.string());
  }
  if (fs::is_directory(file)) throw std::runtime_error(file.string() + ": is a folder");
}

}  // namespace kintsugi
