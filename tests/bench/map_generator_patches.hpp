#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "tests/bench/map_generator_file.hpp"

namespace kintsugi::segmenter::bench {

/// Cuts a map into patches as a mapper sends them: one for each tile of space with points, with one
/// point for each voxel, in the order of tiles and of voxels in them. All are of session 1 and may
/// still change.
std::vector<CloudSlice> cut_into_patches(const Slices& slices, double tile_m, double voxel_m);

/// Correction number `number` of a map: its patches go to where they are when the map, straight
/// along x so far, is bent to an arc of this curvature, as a closed loop bends it. Each moves and
/// turns with the place on the axis that is beside its middle.
CloudSlice correction_to_arc(std::span<const CloudSlice> patches, double curvature_per_m,
                             std::int32_t id, std::int32_t number);

}  // namespace kintsugi::segmenter::bench
