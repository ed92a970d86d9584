#pragma once

#include <vector>

#include "mapper/core/loop_closure/map_deformation.hpp"
#include "mapper/core/slices/tile.hpp"

namespace kintsugi::mapper {

/// Patches that are sent together.
struct PatchBatch {
  struct Patch {
    TileCoord tile;
    bool in_volume = true;  ///< false: its surface has left the volume for good
    int keyframe = 0;       ///< at which its surface was seen last; the patch moves with it
    MapDeformation::Place place = {};  ///< where that keyframe has moved to by now
  };
  /// Ascending. A tile that the volume has left and come back to is there twice.
  std::vector<Patch> patches;
};

}  // namespace kintsugi::mapper
