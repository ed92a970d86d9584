#pragma once

#include <filesystem>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::mapper {

/// Reads the points of a map from a PLY file of CloudWriter, or from the slices in an LCM log (of
/// the last session, the highest revision of each slice), which must be whole.
/// @throws std::runtime_error naming the file and what is wrong with it
std::vector<CloudPoint> read_cloud(const std::filesystem::path& path);

}  // namespace kintsugi::mapper
