#pragma once

#include <filesystem>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::mapper {

/// The points of a map: of a PLY file that CloudWriter wrote, or of the slices in an LCM log (the
/// highest revision of each, of the session seen last).
/// @throws std::runtime_error naming the file and what is wrong with it
std::vector<CloudPoint> read_cloud(const std::filesystem::path& path);

}  // namespace kintsugi::mapper
