#pragma once
// The ground truth of a synthetic sequence, as files.

#include <filesystem>

#include "mapper/synthetic/render/sequence.hpp"

namespace kintsugi::synthetic {

/// Writes the following files, each complete or not at all, and creates the folder if needed:
///   groundtruth.txt  X_WC of each frame, `timestamp tx ty tz qx qy qz qw` (TUM), seconds, metres
///   camera.txt       `fx fy cx cy width height depth_scale`
///   instances.json   id, name, model, key, shape, colour and number of solids of each instance
///   (see
///                    Instance), whether it is part of the building (is_structure) or an object,
///                    its pose X_SG in the scene's frame (12 numbers, rows of 3 x 4) and its
///                    symmetry: centre_G and axes, each a direction_G and its order, 0 for any
///                    angle
/// W is the frame of the scene: z up, the floor of the first storey at z = 0 (see Scene).
/// @throws std::system_error naming the file
void write_ground_truth(const Sequence& sequence, const std::filesystem::path& folder);

}  // namespace kintsugi::synthetic
