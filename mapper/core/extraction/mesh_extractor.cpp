#include "mapper/core/extraction/mesh_extractor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/extraction/block_points.hpp"
#include "mapper/core/extraction/corner_rows.hpp"
#include "mapper/core/extraction/cube_triangles.hpp"
#include "mapper/core/extraction/slice_blocks.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::uint32_t kNoVertex = ~std::uint32_t{0};

/// The colour at `share` of the way from one voxel to the next; where only one of them has a
/// colour, that colour.
std::array<std::uint8_t, 3> blend(VoxelColor from, VoxelColor to, double share) {
  if (from >> 24 == 0) from = to;
  if (to >> 24 == 0) to = from;
  std::array<std::uint8_t, 3> color{};
  for (int channel = 0; channel < 3; ++channel) {
    const double a = from >> (8 * channel) & 0xFFU;
    const double b = to >> (8 * channel) & 0xFFU;
    color[channel] = static_cast<std::uint8_t>(std::lround(a + share * (b - a)));
  }
  return color;
}

bool borders_on_volume(const DetachedBlocks& detached, const BlockCoord& coord) {
  return std::binary_search(detached.bordering_coords.begin(), detached.bordering_coords.end(),
                            coord);
}

}  // namespace

/// The vertices on the lines from a block's voxels to the next voxel along an axis; index
/// 3 voxel + axis.
struct MeshExtractor::BlockEdges {
  std::array<std::uint32_t, 3 * std::size_t{kBlockVoxels}> vertices;

  BlockEdges() { vertices.fill(kNoVertex); }
};

/// The extraction of one slice.
class MeshExtractor::Pass {
 public:
  Pass(MeshExtractor& mesh, const DetachedBlocks& detached)
      : mesh_(mesh),
        detached_(detached),
        rule_(mesh.config_.weight_threshold, mesh.config_.max_step_vox, detached.resolution_m,
              detached.truncation_m),
        blocks_(detached),
        sides_(blocks_.size()),
        edges_(blocks_.size()) {
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      sides_[i] = observed_sides(*blocks_[i].voxels, rule_.weight_threshold);
      const auto known = mesh.borders_.extract(blocks_[i].coord);
      // An own block at the same place has left for a second time: its vertices are new.
      if (!known.empty() && !blocks_[i].is_own) edges_[i] = std::move(known.mapped());
    }
  }

  MeshPiece run() {
    NeighborWalk walk(blocks_);
    std::size_t num_kept = 0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      for (; blocks_[num_kept].coord.z < blocks_[i].coord.z; ++num_kept) keep_border(num_kept);
      mesh_block(walk.around(i));
    }
    for (; num_kept < blocks_.size(); ++num_kept) keep_border(num_kept);
    return std::move(piece_);
  }

 private:
  using Octant = std::array<int, 8>;  ///< as in CornerRows; kNoNeighbor: no block

  void mesh_block(const BlockNeighbors& neighbors) {
    Octant octant;
    for (int k = 0; k < 8; ++k) octant[k] = neighbors[neighbor_index(k & 1, k >> 1 & 1, k >> 2)];
    const std::array<bool, 8> is_due = due_cubes(octant);
    if (!may_have_surface(octant)) return;
    std::array<const VoxelBlock*, 8> voxels{};
    for (int k = 0; k < 8; ++k) {
      if (octant[k] != kNoNeighbor) voxels[k] = blocks_[octant[k]].voxels;
    }
    const CornerRows corners(voxels, mesh_.config_.weight_threshold);
    for (int z = 0; z < kBlockSide; ++z) {
      for (int y = 0; y < kBlockSide; ++y) {
        for (unsigned left = corners.cubes_with_surface(y, z); left != 0; left &= left - 1) {
          const int x = std::countr_zero(left);
          const auto is_last = [](int c) { return c == kBlockSide - 1 ? 1 : 0; };
          if (!is_due[is_last(x) + 2 * is_last(y) + 4 * is_last(z)]) continue;
          mesh_cube(octant, {x, y, z}, corners.corners_behind(x, y, z));
        }
      }
    }
  }

  /// Which cubes to mesh in this slice: those with a block that leaves now and none that stays. The
  /// index has a bit for each axis along which the cube reaches into the next block.
  std::array<bool, 8> due_cubes(const Octant& octant) const {
    std::array<bool, 8> is_due{};
    for (int sides = 0; sides < 8; ++sides) {
      bool leaves = false;
      bool stays = false;
      for (int k = 0; k < 8; ++k) {
        if ((k & ~sides) != 0 || octant[k] == kNoNeighbor) continue;
        const SliceBlocks::Block& block = blocks_[octant[k]];
        leaves |= block.is_own;
        stays |= block.colors == nullptr;
      }
      is_due[sides] = leaves && !stays;
    }
    return is_due;
  }

  bool may_have_surface(const Octant& octant) const {
    bool free_space = false;
    bool behind = false;
    for (const int block : octant) {
      if (block == kNoNeighbor) continue;
      free_space |= sides_[block].free_space;
      behind |= sides_[block].behind;
    }
    return free_space && behind;
  }

  void mesh_cube(const Octant& octant, const std::array<int, 3>& cube, unsigned corners_behind) {
    if (jumps(octant, cube, corners_behind)) return;
    for (const auto& edges : cube_triangles(corners_behind)) {
      piece_.triangles.push_back({vertex_on(octant, cube, kCubeEdges[edges[0]]),
                                  vertex_on(octant, cube, kCubeEdges[edges[1]]),
                                  vertex_on(octant, cube, kCubeEdges[edges[2]])});
    }
  }

  struct Corner {
    int block = kNoNeighbor;
    std::array<int, 3> position_vox{};  ///< in the block
    int voxel = 0;
  };
  static Corner corner_of(const Octant& octant, const std::array<int, 3>& cube, int corner) {
    Corner result;
    int side = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int c = cube[axis] + (corner >> axis & 1);
      side |= c / kBlockSide << axis;
      result.position_vox[axis] = c % kBlockSide;
    }
    const auto& [x, y, z] = result.position_vox;
    result.voxel = voxel_index(x, y, z);
    result.block = octant[side];
    return result;
  }

  /// Whether the distance jumps along an edge of the cube that has a crossing.
  bool jumps(const Octant& octant, const std::array<int, 3>& cube, unsigned corners_behind) const {
    std::array<int, 8> distances{};
    for (int corner = 0; corner < 8; ++corner) {
      const Corner c = corner_of(octant, cube, corner);
      distances[corner] = voxel_distance_raw(blocks_[c.block].voxels->voxels[c.voxel]);
    }
    return std::any_of(kCubeEdges.begin(), kCubeEdges.end(), [&](const CubeEdge& edge) {
      const bool crosses = ((corners_behind >> edge.from ^ corners_behind >> edge.to) & 1U) != 0;
      return crosses && std::abs(distances[edge.from] - distances[edge.to]) > rule_.max_step_raw;
    });
  }

  std::uint32_t vertex_on(const Octant& octant, const std::array<int, 3>& cube,
                          const CubeEdge& edge) {
    const Corner from = corner_of(octant, cube, edge.from);
    auto& edges = edges_[from.block];
    if (!edges) edges = std::make_unique<BlockEdges>();
    std::uint32_t& vertex = edges->vertices[3 * from.voxel + edge.axis];
    if (vertex == kNoVertex) {
      vertex = mesh_.num_vertices_++;
      piece_.vertices.push_back(make_vertex(from, corner_of(octant, cube, edge.to), edge.axis));
    }
    return vertex;
  }

  MeshPiece::Vertex make_vertex(const Corner& from, const Corner& to, int axis) const {
    const SliceBlocks::Block& block = blocks_[from.block];
    const SliceBlocks::Block& next = blocks_[to.block];
    // Half a quantisation step is added so that no voxel lies exactly on the surface and no two
    // vertices coincide.
    const double here = voxel_distance_raw(block.voxels->voxels[from.voxel]) + 0.5;
    const double there = voxel_distance_raw(next.voxels->voxels[to.voxel]) + 0.5;
    const double share = here / (here - there);
    const std::array<int, 3> coord = {block.coord.x, block.coord.y, block.coord.z};
    std::array<float, 3> p_W{};
    for (int i = 0; i < 3; ++i) {
      const double p_vox =
          coord[i] * kBlockSide + from.position_vox[i] + 0.5 + (i == axis ? share : 0.0);
      p_W[i] = static_cast<float>(p_vox * detached_.resolution_m);
    }
    return {p_W[0], p_W[1], p_W[2],
            blend(block.colors->colors[from.voxel], next.colors->colors[to.voxel], share)};
  }

  /// Keeps the vertices of a block that borders on the volume, because later slices share them.
  void keep_border(std::size_t i) {
    const BlockCoord& coord = blocks_[i].coord;
    if (edges_[i] && borders_on_volume(detached_, coord)) {
      mesh_.borders_[coord] = std::move(edges_[i]);
    }
    edges_[i].reset();
  }

  MeshExtractor& mesh_;
  const DetachedBlocks& detached_;
  const CrossingRule rule_;
  const SliceBlocks blocks_;
  std::vector<ObservedSides> sides_;
  std::vector<std::unique_ptr<BlockEdges>> edges_;
  MeshPiece piece_;
};

void MeshExtractor::Config::validate() const {
  check_range("weight_threshold", weight_threshold, 0, 65534);
  check_range("max_step_vox", max_step_vox, 1.0, 100.0);
}

MeshExtractor::MeshExtractor(const Config& config) : config_(config) { config_.validate(); }

MeshExtractor::~MeshExtractor() = default;

MeshPiece MeshExtractor::extract(const DetachedBlocks& detached) {
  MeshPiece piece = Pass(*this, detached).run();
  std::erase_if(borders_,
                [&](const auto& border) { return !borders_on_volume(detached, border.first); });
  return piece;
}

}  // namespace kintsugi::mapper
