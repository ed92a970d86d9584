#pragma once

#include <filesystem>

#include "lcmtypes/geometry.hpp"

namespace kintsugi::mapper {

/// The content of a camera.txt.
struct Calibration {
  Intrinsics intrinsics;
  double depth_units_per_m = 1000.0;  ///< raw depth value / this = metres, > 0
};

/// Reads a camera.txt: blank lines, `#` comments, and one line
///   fx fy cx cy width height depth_scale [k1 k2 p1 p2 k3]
/// in pixels, with depth_scale in raw units per metre. Without the last five there is no
/// distortion. fy may be negative (ICL-NUIM): then C's y axis points up in the images; everything
/// stays as it is in the file.
/// @throws std::runtime_error naming file, line, field, its value and what was expected
Calibration read_calibration(const std::filesystem::path& file);

}  // namespace kintsugi::mapper
