#pragma once

#include <cstddef>

namespace kintsugi::mapper {

inline constexpr int kNoPatch = -1;

/// Points that come one after the other and are of one patch.
struct PatchRun {
  std::size_t num_points = 0;
  int patch = kNoPatch;  ///< number of the patch in PatchMaker, which is not its id
  int part = 0;          ///< of the map; of points that are of no patch
};

}  // namespace kintsugi::mapper
