#include "mapper/output/part_file.hpp"

#include <string>

namespace kintsugi::mapper {

std::filesystem::path part_file(const std::filesystem::path& file, int part) {
  if (part == 0) return file;
  std::filesystem::path name = file.stem();
  name += ".part" + std::to_string(part);
  name += file.extension();
  return file.parent_path() / name;
}

}  // namespace kintsugi::mapper
