#pragma once

#include <filesystem>
#include <string>

#include "lcmtypes/base/atomic_file.hpp"

namespace kintsugi::segmenter {

/// Writes the file beside its name, and renames it when it is whole.
/// @throws std::system_error naming the file that could not be written
inline void write_text_file(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

}  // namespace kintsugi::segmenter
