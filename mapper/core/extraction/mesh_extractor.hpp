#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "mapper/core/volume/detached_blocks.hpp"

namespace kintsugi::mapper {

/// A part of a triangle mesh. The vertices follow those of the pieces before it.
struct MeshPiece {
  struct Vertex {
    float x = 0.0F;  ///< metres, W
    float y = 0.0F;
    float z = 0.0F;
    std::array<std::uint8_t, 3> color_rgb{};

    bool operator==(const Vertex&) const = default;
  };
  using Triangle = std::array<std::uint32_t, 3>;  ///< indices of vertices, of any piece so far

  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;  ///< counter-clockwise seen from free space
};

/// The surface of a run as one triangle mesh with colour, slice by slice: marching cubes between
/// the centres of voxels, each vertex on the line between two of them and in the mesh only once.
///
/// Where SurfaceExtractor finds no crossing because the distance jumps, the mesh ends.
///
/// A cube that reaches into several blocks is meshed when the last of them leaves, with each block
/// as it left. So the mesh is closed between slices even where a block went on changing after its
/// neighbour had left. Where the volume comes back and maps a place again, a new sheet begins that
/// overlaps the old one and is not joined to it.
///
/// Memory: the piece in hand, and 6 KB for each block with surface that left and still touches the
/// volume (of the piece in hand: two layers of blocks).
class MeshExtractor {
 public:
  struct Config {
    int weight_threshold = 8;   ///< voxels with no more observations than this are ignored
    double max_step_vox = 4.0;  ///< between neighbours: no surface where the distance jumps

    /// @throws std::invalid_argument naming the field, its value and the bound.
    void validate() const;
  };

  explicit MeshExtractor(const Config& config);
  ~MeshExtractor();

  /// What the slice adds to the mesh. The slices of a run in the order in which they left.
  MeshPiece extract(const DetachedBlocks& detached);

 private:
  struct BlockEdges;
  class Pass;

  Config config_;
  std::uint32_t num_vertices_ = 0;
  /// Of the blocks that left and touch the volume.
  std::map<BlockCoord, std::unique_ptr<BlockEdges>> borders_;
};

}  // namespace kintsugi::mapper
