#pragma once
// The outlines of near surfaces in a depth image.

#include <vector>

#include "mapper/core/frame/surface_map.hpp"

namespace kintsugi::mapper {

/// Where a line of pixels (a row or a column) crosses an outline: the last pixel of a surface
/// before another one that is farther away.
struct EdgePixel {
  float position_px = 0.0F;  ///< along the line, on the border of the near pixel
  float slope = 0.0F;        ///< change of the position from one line to the next
  float depth_m = 0.0F;      ///< of the near surface
  bool ends = false;         ///< the near surface is on the side of lower positions
};

/// The edges of each row or column of an image.
using EdgeLines = std::vector<std::vector<EdgePixel>>;

/// Outlines that are less than 45 degrees from vertical are in the rows, the others in the columns.
struct DepthEdges {
  EdgeLines rows;
  EdgeLines columns;
};

/// Finds the outlines. Invalid pixels between the two surfaces, such as the shadow of a projector,
/// are skipped. Two depths are different surfaces where DepthTolerance says so. An outline that
/// does not go on over the two lines on both sides is noise and is left out.
DepthEdges find_depth_edges(const SurfaceMap& surface);

}  // namespace kintsugi::mapper
