#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lcmtypes/scene/tile.hpp"

namespace kintsugi::viewer {

/// A segment beside another one.
struct Neighbour {
  std::uint32_t segment_id = 0;
  std::uint32_t contacts = 0;  ///< its points in the cells of the other one, or beside them

  bool operator==(const Neighbour&) const = default;
};

/// The segments with points within about two voxels of the segment's: in the same cell of two
/// voxels or in one that shares a face with it. Most contacts first. Takes time proportional to the
/// points of the tiles that have the segment or are near it.
std::vector<Neighbour> neighbours_of(std::span<const scene::Tile> tiles, std::uint32_t segment_id);

}  // namespace kintsugi::viewer
