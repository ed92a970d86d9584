#pragma once
// What is known of a synthetic sequence, as files.

#include <filesystem>

#include "mapper/synthetic/render/sequence.hpp"

namespace kintsugi::synthetic {

/// Makes the folder if need be and writes, each whole or not at all:
///   groundtruth.txt  X_WC of each frame, `timestamp tx ty tz qx qy qz qw` (TUM), seconds, metres
///   camera.txt       `fx fy cx cy width height depth_scale`
///   instances.json   of each instance its id, name, shape, colour, number of solids, and whether
///   it is
///                    of the building (is_structure) or an object
/// W is the scene's frame: z up, the first floor at z = 0. A mapper that tracks starts its map at
/// the first camera pose instead, so align before comparing.
/// @throws std::system_error naming the file.
void write_ground_truth(const Sequence& sequence, const std::filesystem::path& folder);

}  // namespace kintsugi::synthetic
