#pragma once

#include <vector>

#include "mapper/core/relocalization/keyframe_map.hpp"
#include "mapper/core/volume/tsdf_block.hpp"

namespace kintsugi::mapper {

/// The blocks in which points of a keyframe's surface are, evenly chosen among its pixels; a block
/// is there as often as it has such points.
std::vector<BlockCoord> blocks_seen_from(const Keyframe& keyframe, double resolution_m);

}  // namespace kintsugi::mapper
