#pragma once

#include <vector>

#include "lcmtypes/geometry.hpp"
#include "lcmtypes/messages.hpp"
#include "tests/bench/map_generator_file.hpp"

namespace kintsugi::segmenter::bench {

/// Cuts a map into patches as a mapper sends them: one for each tile of space with points, with one
/// point for each voxel, in the order of tiles and of voxels in them. All are of session 1 and may
/// still change.
std::vector<CloudSlice> cut_into_patches(const Slices& slices, double tile_m, double voxel_m);

/// Where a patch is when the map, straight along x so far, is bent to an arc of this curvature, as
/// a closed loop bends it: it moves and turns with the place on the axis that is beside its middle.
Pose place_on_arc(const CloudSlice& patch, double curvature_per_m);

}  // namespace kintsugi::segmenter::bench
