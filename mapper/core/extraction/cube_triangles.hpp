#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace kintsugi::mapper {

/// The surface in a cube of eight voxel centres, by which of them are behind it: marching cubes
/// (Lorensen and Cline 1987).
///
/// Corner c is at (c & 1, c >> 1 & 1, c >> 2). Edge 4 axis + k runs along `axis` from the k-th
/// corner, ascending, that has no bit for that axis.
struct CubeEdge {
  int axis = 0;
  int from = 0;  ///< corner
  int to = 0;    ///< corner
};
inline constexpr int kNumCubeEdges = 12;
extern const std::array<CubeEdge, kNumCubeEdges> kCubeEdges;

/// Triangles of edges, counter-clockwise seen from free space.
using CubeTriangles = std::vector<std::array<std::uint8_t, 3>>;

/// For the cube whose corners with a set bit are behind the surface. The lines in which triangles
/// meet a face depend on that face's corners alone, so that neighbouring cubes always fit: where
/// the corners of a face alternate, each of the two behind the surface is cut off by itself.
const CubeTriangles& cube_triangles(unsigned corners_behind);

}  // namespace kintsugi::mapper
