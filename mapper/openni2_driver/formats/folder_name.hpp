#pragma once

#include <filesystem>
#include <string>

namespace kintsugi::mapper {

/// The last part of a folder's path, also where it ends with a slash or is ".".
inline std::string name_of(const std::filesystem::path& folder) {
  return std::filesystem::absolute(folder / "")
      .lexically_normal()
      .parent_path()
      .filename()
      .string();
}

}  // namespace kintsugi::mapper
