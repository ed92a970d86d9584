#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mapper/core/extraction/cube_triangles.hpp"
#include "mapper/core/extraction/mesh_extractor.hpp"
#include "tests/mapper/core/exact_volume.hpp"
#include "tests/mapper/core/scene_fusion.hpp"

namespace kintsugi::mapper {
namespace {

using testing::exact_volume;
using testing::fuse;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr double kResolution_m = 0.01;

Eigen::Vector3d position_W(const MeshPiece::Vertex& v) { return {v.x, v.y, v.z}; }

void append(MeshPiece& mesh, const MeshPiece& piece) {
  mesh.vertices.insert(mesh.vertices.end(), piece.vertices.begin(), piece.vertices.end());
  mesh.triangles.insert(mesh.triangles.end(), piece.triangles.begin(), piece.triangles.end());
}

/// How often each edge is run through in its direction.
std::map<Edge, int> directed_edges(const MeshPiece& mesh) {
  std::map<Edge, int> edges;
  for (const MeshPiece::Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  }
  return edges;
}

/// Edges without their reverse: the rim.
int num_open_edges(const MeshPiece& mesh) {
  const auto edges = directed_edges(mesh);
  int open = 0;
  for (const auto& [edge, count] : edges) {
    const auto reverse = edges.find({edge.second, edge.first});
    if (reverse == edges.end() || reverse->second != count) ++open;
  }
  return open;
}

/// Every edge in two triangles, once in each direction: closed, and oriented alike everywhere.
void expect_closed_manifold(const MeshPiece& mesh) {
  EXPECT_EQ(num_open_edges(mesh), 0);
  for (const auto& [edge, count] : directed_edges(mesh)) ASSERT_EQ(count, 1);
}

void expect_each_vertex_once_and_used(const MeshPiece& mesh) {
  std::set<std::tuple<float, float, float>> positions;
  for (const MeshPiece::Vertex& v : mesh.vertices) positions.insert({v.x, v.y, v.z});
  EXPECT_EQ(positions.size(), mesh.vertices.size());
  std::set<std::uint32_t> used;
  for (const MeshPiece::Triangle& t : mesh.triangles) used.insert(t.begin(), t.end());
  EXPECT_EQ(used.size(), mesh.vertices.size());
  EXPECT_EQ(*used.rbegin() + 1, mesh.vertices.size());
}

/// V - E + F of a closed mesh: 2 for each sphere.
int euler_characteristic(const MeshPiece& mesh) {
  const auto num_edges = static_cast<int>(mesh.triangles.size() * 3 / 2);
  return static_cast<int>(mesh.vertices.size()) - num_edges +
         static_cast<int>(mesh.triangles.size());
}

Eigen::Vector3d area_vector(const MeshPiece& mesh, const MeshPiece::Triangle& t) {
  const Eigen::Vector3d a = position_W(mesh.vertices[t[0]]);
  return 0.5 * (position_W(mesh.vertices[t[1]]) - a).cross(position_W(mesh.vertices[t[2]]) - a);
}

MeshPiece mesh_of(const DetachedBlocks& blocks, int weight_threshold = 0) {
  return MeshExtractor({.weight_threshold = weight_threshold}).extract(blocks);
}

/// The volume's mesh in pieces: the camera leaves in small steps, nothing comes back.
MeshPiece mesh_in_slices(TsdfVolume& volume, int num_steps, int* num_slices) {
  MeshExtractor extractor({.weight_threshold = 0});
  MeshPiece mesh;
  Eigen::Vector3d camera_W = volume.center_W();
  for (int step = 0; step < num_steps; ++step) {
    const Eigen::Vector3d directions_W[] = {{0.17, 0.05, 0.0}, {0.0, 0.0, -0.25}, {0.3, 0.3, -0.1}};
    camera_W += directions_W[step % 3];
    for (const DetachedBlocks& slice : volume.shift_to(camera_W)) {
      append(mesh, extractor.extract(slice));
      ++*num_slices;
    }
  }
  append(mesh, extractor.extract(volume.detach_all()));
  return mesh;
}

TEST(CubeTriangles, NeighboursMeetInTheSameLinesWhateverTheirCorners) {
  // The rim of a cube's surface on its face x = 1 must be, reversed, that of the next one's x = 0.
  const auto lines_on_face = [](unsigned corners, int side) {
    std::set<std::pair<int, int>> lines;
    std::map<std::pair<int, int>, int> count;
    for (const auto& t : cube_triangles(corners)) {
      for (int i = 0; i < 3; ++i) {
        const int a = t[i];
        const int b = t[(i + 1) % 3];
        const auto on_face = [&](int edge) {
          return (kCubeEdges[edge].from & 1) == side && (kCubeEdges[edge].to & 1) == side;
        };
        // Both vertices on the face, as the corners of the other cube name them.
        if (!on_face(a) || !on_face(b)) continue;
        const auto name = [&](int edge) {
          return 10 * kCubeEdges[edge].axis + (kCubeEdges[edge].from >> 1);
        };
        ++count[{name(a), name(b)}];
      }
    }
    for (const auto& [line, n] : count) {
      if (count.find({line.second, line.first}) == count.end()) lines.insert(line);
    }
    return lines;
  };
  for (unsigned left = 0; left < 256; ++left) {
    for (unsigned upper = 0; upper < 16; ++upper) {
      unsigned right = 0;
      for (int yz = 0; yz < 4; ++yz) {
        right |= (left >> (2 * yz + 1) & 1U) << (2 * yz);  // the shared corners
        right |= (upper >> yz & 1U) << (2 * yz + 1);
      }
      std::set<std::pair<int, int>> reversed;
      for (const auto& [a, b] : lines_on_face(right, 0)) reversed.insert({b, a});
      ASSERT_EQ(lines_on_face(left, 1), reversed) << left << " beside " << right;
    }
  }
}

TEST(MeshExtractor, ClosesAnExactSphere) {
  constexpr double kRadius_m = 0.3;
  const Eigen::Vector3d center_W(0.013, -0.021, 0.037);
  TsdfVolume volume = exact_volume(1.0, kResolution_m, 10, [&](const Eigen::Vector3d& p_W) {
    return (p_W - center_W).norm() - kRadius_m;
  });
  const MeshPiece mesh = mesh_of(volume.snapshot());
  ASSERT_GT(mesh.triangles.size(), 10000U);
  expect_closed_manifold(mesh);
  expect_each_vertex_once_and_used(mesh);
  EXPECT_EQ(euler_characteristic(mesh), 2);  // one piece, genus 0
  // Between two voxels the distance bends by 1/(8 R) voxels = 0.4 % of one.
  constexpr double kTolerance_m = 0.01 * kResolution_m;
  for (const MeshPiece::Vertex& v : mesh.vertices) {
    ASSERT_NEAR((position_W(v) - center_W).norm(), kRadius_m, kTolerance_m);
  }
  double area_m2 = 0.0;
  for (const MeshPiece::Triangle& t : mesh.triangles) {
    const Eigen::Vector3d area = area_vector(mesh, t);
    area_m2 += area.norm();
    if (area.norm() < 0.05 * kResolution_m * kResolution_m) continue;  // slivers face anywhere
    const Eigen::Vector3d outwards = position_W(mesh.vertices[t[0]]) - center_W;
    ASSERT_GT(area.normalized().dot(outwards.normalized()), 0.9);
  }
  // Chords of a voxel's diagonal lie h = l^2 / (8 R) = 0.1 mm below: 0.1 % of the area.
  EXPECT_NEAR(area_m2 / (4 * std::numbers::pi * kRadius_m * kRadius_m), 1.0, 0.002);
}

TEST(MeshExtractor, ClosesAFusedSphere) {
  const auto scene = synthetic::make_scene("sphere");
  TsdfVolume volume(
      {.region = RegionShape::kCube, .volume_size_m = 1.6, .resolution_m = kResolution_m});
  fuse(testing::views_around(scene, 1.3, {-0.9, -0.3, 0.3, 0.9}, 12), volume);
  const MeshPiece mesh = mesh_of(volume.snapshot());
  ASSERT_GT(mesh.triangles.size(), 40000U);
  expect_each_vertex_once_and_used(mesh);
  // The largest piece is the sphere; nothing open in it means all of the mesh is closed but for
  // scraps at the edge of what was seen behind it.
  EXPECT_EQ(num_open_edges(mesh), 0);
  double area_m2 = 0.0;
  for (const MeshPiece::Triangle& t : mesh.triangles) area_m2 += area_vector(mesh, t).norm();
  EXPECT_NEAR(area_m2 / std::numbers::pi, 1.0, 0.02);
}

TEST(MeshExtractor, JoinsSlicesToTheMeshOfTheWhole) {
  const auto scene = synthetic::make_scene("sphere");
  TsdfVolume volume(
      {.region = RegionShape::kCube, .volume_size_m = 1.6, .resolution_m = kResolution_m});
  fuse(testing::views_around(scene, 1.3, {-0.9, -0.3, 0.3, 0.9}, 6), volume);
  const MeshPiece whole = mesh_of(volume.snapshot());
  int num_slices = 0;
  const MeshPiece joined = mesh_in_slices(volume, 6, &num_slices);
  ASSERT_GE(num_slices, 6);
  EXPECT_EQ(num_open_edges(joined), num_open_edges(whole));
  expect_each_vertex_once_and_used(joined);
  const auto sorted_positions = [](const MeshPiece& mesh) {
    std::vector<std::array<float, 9>> triangles;
    for (const MeshPiece::Triangle& t : mesh.triangles) {
      std::array<std::array<float, 3>, 3> corners{};
      for (int i = 0; i < 3; ++i) {
        const MeshPiece::Vertex& v = mesh.vertices[t[i]];
        corners[i] = {v.x, v.y, v.z};
      }
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      std::array<float, 9> flat{};
      for (int i = 0; i < 9; ++i) flat[i] = corners[i / 3][i % 3];
      triangles.push_back(flat);
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  };
  EXPECT_TRUE(sorted_positions(joined) == sorted_positions(whole));
}

TEST(MeshExtractor, ClosesASphereThatLeavesAFullBallInPieces) {
  constexpr double kRadius_m = 0.4;
  TsdfVolume volume({.max_range_m = 0.6, .resolution_m = kResolution_m, .max_memory_mb = 2.0});
  const auto sphere = [](const Eigen::Vector3d& p_W) { return p_W.norm() - kRadius_m; };
  testing::allocate_around_surface(volume, sphere);
  testing::set_exact_distances(volume, 10, sphere);
  MeshExtractor extractor({.weight_threshold = 0});
  MeshPiece mesh;
  int num_slices = 0;
  for (int lowest = -8; lowest <= 16; ++lowest) {
    for (const DetachedBlocks& slice : volume.shift_to(Eigen::Vector3d::Zero())) {
      append(mesh, extractor.extract(slice));
      ++num_slices;
    }
    for (BlockSlot slot = 0; slot < volume.slots_end(); ++slot) {
      const BlockCoord& coord = volume.coord(slot);
      if (volume.in_use(slot) && coord.x + coord.y >= lowest) volume.mark_seen(slot);
    }
  }
  ASSERT_GE(num_slices, 3);
  append(mesh, extractor.extract(volume.detach_all()));
  expect_closed_manifold(mesh);
  expect_each_vertex_once_and_used(mesh);
  EXPECT_EQ(euler_characteristic(mesh), 2);
}

TEST(MeshExtractor, StaysClosedWhereBlocksChangeAfterTheirNeighboursLeft) {
  // A sphere that grows a little between slices: what left earlier has the smaller radius.
  const auto grown = [](double radius_m) {
    return [radius_m](const Eigen::Vector3d& p_W) { return p_W.norm() - radius_m; };
  };
  TsdfVolume volume = exact_volume(1.0, kResolution_m, 10, grown(0.3));
  MeshExtractor extractor({.weight_threshold = 0});
  MeshPiece mesh;
  Eigen::Vector3d camera_W = Eigen::Vector3d::Zero();
  for (int step = 1; step <= 5; ++step) {
    camera_W += Eigen::Vector3d(0.16, 0.08, 0.0);
    for (const DetachedBlocks& slice : volume.shift_to(camera_W))
      append(mesh, extractor.extract(slice));
    testing::set_exact_distances(volume, 10, grown(0.3 + 0.001 * step));
  }
  append(mesh, extractor.extract(volume.detach_all()));
  expect_closed_manifold(mesh);
  expect_each_vertex_once_and_used(mesh);
  EXPECT_EQ(euler_characteristic(mesh), 2);
}

TEST(MeshExtractor, BeginsANewSheetWhereTheVolumeComesBack) {
  const auto sphere = [](const Eigen::Vector3d& p_W) { return p_W.norm() - 0.2; };
  TsdfVolume volume = exact_volume(0.8, kResolution_m, 10, sphere);
  MeshExtractor extractor({.weight_threshold = 0});
  MeshPiece mesh;
  const auto leave_and_return = [&] {
    for (const DetachedBlocks& slice : volume.shift_to({5.0, 0.0, 0.0}))
      append(mesh, extractor.extract(slice));
    for (const DetachedBlocks& slice : volume.shift_to({0.0, 0.0, 0.0}))
      append(mesh, extractor.extract(slice));
  };
  leave_and_return();
  const std::size_t once = mesh.triangles.size();
  testing::allocate_around_surface(volume, sphere);
  testing::set_exact_distances(volume, 10, sphere);
  leave_and_return();
  EXPECT_GT(once, 1000U);
  EXPECT_EQ(mesh.triangles.size(), 2 * once);
  EXPECT_EQ(num_open_edges(mesh), 0);
  EXPECT_EQ(euler_characteristic(mesh), 4);  // two spheres, not joined
}

TEST(MeshExtractor, IgnoresVoxelsSeenNoMoreOftenThanTheThreshold) {
  const auto plane = [](const Eigen::Vector3d& p_W) { return p_W.z() - 0.003; };
  EXPECT_TRUE(mesh_of(exact_volume(0.64, kResolution_m, 8, plane).snapshot(), 8).triangles.empty());
  EXPECT_EQ(mesh_of(exact_volume(0.64, kResolution_m, 9, plane).snapshot(), 8).triangles.size(),
            2U * 63U * 63U);
}

TEST(MeshExtractor, TakesTheColorThatWasSeen) {
  const auto scene = synthetic::make_scene("plane");
  testing::View view =
      testing::make_view(scene, synthetic::look_at({0.0, -0.3, 0.8}, {0.0, 0.0, 0.0}));
  view.frame.color_rgb.setTo(cv::Scalar(200, 100, 7));
  TsdfVolume volume(
      {.region = RegionShape::kCube, .volume_size_m = 2.4, .resolution_m = kResolution_m});
  fuse({view, view, view}, volume);
  const MeshPiece mesh = mesh_of(volume.snapshot());
  ASSERT_FALSE(mesh.vertices.empty());
  for (const MeshPiece::Vertex& v : mesh.vertices) {
    ASSERT_THAT(v.color_rgb, ::testing::ElementsAre(200, 100, 7));
  }
}

TEST(MeshExtractor, FindsNothingInNothing) {
  EXPECT_TRUE(mesh_of(DetachedBlocks{}).triangles.empty());
  EXPECT_THROW(MeshExtractor({.weight_threshold = -1}), std::invalid_argument);
}

}  // namespace
}  // namespace kintsugi::mapper
