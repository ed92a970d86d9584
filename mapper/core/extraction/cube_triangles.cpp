#include "mapper/core/extraction/cube_triangles.hpp"

#include <algorithm>
#include <utility>

namespace kintsugi::mapper {
namespace {

constexpr int kNone = -1;

constexpr std::array<CubeEdge, kNumCubeEdges> make_edges() {
  std::array<CubeEdge, kNumCubeEdges> edges{};
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 8; ++corner) {
      if ((corner >> axis & 1) == 0) edges[count++] = {axis, corner, corner | 1 << axis};
    }
  }
  return edges;
}

int edge_between(int corner, int other) {
  const auto found = std::find_if(kCubeEdges.begin(), kCubeEdges.end(), [&](const CubeEdge& edge) {
    return edge.from == std::min(corner, other) && edge.to == std::max(corner, other);
  });
  return static_cast<int>(found - kCubeEdges.begin());
}

/// The corners of a face, counter-clockwise seen from outside the cube.
std::array<int, 4> face_corners(int axis, bool upper) {
  const int a = 1 << (axis + 1) % 3;
  const int b = 1 << (axis + 2) % 3;
  const int base = upper ? 1 << axis : 0;
  if (upper) return {base, base | a, base | a | b, base | b};
  return {base, base | b, base | a | b, base | a};
}

bool share_a_face(int edge, int other) {
  const auto corners_of = [](int e) {
    return std::array<int, 2>{kCubeEdges[e].from, kCubeEdges[e].to};
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto side = [axis](int corner) { return corner >> axis & 1; };
    const int first = side(corners_of(edge)[0]);
    if (side(corners_of(edge)[1]) == first && side(corners_of(other)[0]) == first &&
        side(corners_of(other)[1]) == first)
      return true;
  }
  return false;
}

/// For each edge with a crossing, the edge that follows it on the boundary of the surface in the
/// cube, with free space to the left seen from outside; else kNone. Going around a face, a line
/// starts at the edge that goes from free space to behind the surface, and ends at the next edge
/// that goes back.
std::array<int, kNumCubeEdges> make_rims(unsigned corners_behind) {
  const auto is_behind = [&](int corner) { return (corners_behind >> corner & 1U) != 0; };
  std::array<int, kNumCubeEdges> next{};
  next.fill(kNone);
  for (int face = 0; face < 6; ++face) {
    const std::array<int, 4> corners = face_corners(face / 2, face % 2 != 0);
    for (int i = 0; i < 4; ++i) {
      if (is_behind(corners[i]) || !is_behind(corners[(i + 1) % 4])) continue;
      int last = (i + 1) % 4;
      while (is_behind(corners[(last + 1) % 4])) last = (last + 1) % 4;
      next[edge_between(corners[i], corners[(i + 1) % 4])] =
          edge_between(corners[last], corners[(last + 1) % 4]);
    }
  }
  return next;
}

/// Triangulates a polygon as a fan, from a corner with as few diagonals in faces of the cube as
/// possible: the neighbouring cube could have the same diagonal, and four triangles would share
/// that edge.
void append_fan(const std::vector<int>& polygon, CubeTriangles& triangles) {
  const auto size = static_cast<int>(polygon.size());
  const auto at = [&](int i) { return polygon[i % size]; };
  const auto diagonals_in_faces = [&](int first) {
    int count = 0;
    for (int i = 2; i < size - 1; ++i) count += share_a_face(at(first), at(first + i)) ? 1 : 0;
    return count;
  };
  int best = 0;
  for (int first = 1; first < size; ++first) {
    if (diagonals_in_faces(first) < diagonals_in_faces(best)) best = first;
  }
  for (int i = 1; i < size - 1; ++i) {
    triangles.push_back({static_cast<std::uint8_t>(at(best)),
                         static_cast<std::uint8_t>(at(best + i)),
                         static_cast<std::uint8_t>(at(best + i + 1))});
  }
}

CubeTriangles make_triangles(unsigned corners_behind) {
  std::array<int, kNumCubeEdges> next = make_rims(corners_behind);
  CubeTriangles triangles;
  for (int start = 0; start < kNumCubeEdges; ++start) {
    std::vector<int> polygon;
    for (int edge = start; next[edge] != kNone;) {
      polygon.push_back(edge);
      edge = std::exchange(next[edge], kNone);
    }
    if (!polygon.empty()) append_fan(polygon, triangles);
  }
  return triangles;
}

}  // namespace

constexpr std::array<CubeEdge, kNumCubeEdges> kCubeEdges = make_edges();

const CubeTriangles& cube_triangles(unsigned corners_behind) {
  static const std::array<CubeTriangles, 256> kTable = [] {
    std::array<CubeTriangles, 256> table;
    for (unsigned corners = 0; corners < table.size(); ++corners) {
      table[corners] = make_triangles(corners);
    }
    return table;
  }();
  return kTable[corners_behind];
}

}  // namespace kintsugi::mapper
