#pragma once
// The contents of a file.

#include <filesystem>
#include <string>

namespace kintsugi::segmenter {

/// @throws std::runtime_error naming a file that does not exist, is not a regular one, or cannot be
///   read to its end
std::string read_file_bytes(const std::filesystem::path& path);

}  // namespace kintsugi::segmenter
