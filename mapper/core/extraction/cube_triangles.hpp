#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace kintsugi::mapper {

/// Marching cubes (Lorensen and Cline 1987): the triangles of a cube of eight voxel centres, given
/// which of them are behind the surface.
///
/// Corner c is at (c & 1, c >> 1 & 1, c >> 2). Edge 4 axis + k runs along `axis` from the k-th
/// corner, ascending, whose bit for that axis is 0.
struct CubeEdge {
  int axis = 0;
  int from = 0;  ///< corner
  int to = 0;    ///< corner
};
inline constexpr int kNumCubeEdges = 12;
extern const std::array<CubeEdge, kNumCubeEdges> kCubeEdges;

/// Triangles whose vertices lie on these edges, counter-clockwise seen from free space.
using CubeTriangles = std::vector<std::array<std::uint8_t, 3>>;

/// The triangles of the cube in which the corners with a set bit are behind the surface. The lines
/// in which triangles meet a face depend on the corners of that face alone, so that neighbouring
/// cubes always fit. Where the corners of a face alternate (the ambiguous case), each of the two
/// corners behind the surface is separated from the other.
const CubeTriangles& cube_triangles(unsigned corners_behind);

}  // namespace kintsugi::mapper
