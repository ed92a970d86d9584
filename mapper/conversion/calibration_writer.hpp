#pragma once

#include <filesystem>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// Writes a camera.txt.
/// @throws std::system_error naming the file when it cannot be written
void write_calibration(const std::filesystem::path& file, const Intrinsics& camera,
                       double depth_units_per_m);

}  // namespace kintsugi::mapper
