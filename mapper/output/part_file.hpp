#pragma once

#include <filesystem>

namespace kintsugi::mapper {

/// The file of a part of the map: `file` itself for part 0, FILE.part1.EXT for part 1 and so on.
std::filesystem::path part_file(const std::filesystem::path& file, int part);

}  // namespace kintsugi::mapper
