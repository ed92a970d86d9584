#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "mapper/core/volume/detached_blocks.hpp"

namespace kintsugi::mapper {

/// A part of a triangle mesh. Its vertices are numbered after those of the pieces before it.
struct MeshPiece {
  struct Vertex {
    float x = 0.0F;  ///< metres, W
    float y = 0.0F;
    float z = 0.0F;
    std::array<std::uint8_t, 3> color_rgb{};

    bool operator==(const Vertex&) const = default;
  };
  using Triangle =
      std::array<std::uint32_t, 3>;  ///< indices of vertices, of this or earlier pieces

  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;  ///< counter-clockwise seen from free space
};

/// Extracts the surface of a run as one coloured triangle mesh, slice by slice: marching cubes
/// between the centres of voxels. Neighbouring triangles share their vertices.
///
/// The mesh ends where SurfaceExtractor finds no crossing because the distance jumps.
///
/// A cube that reaches into several blocks is meshed when the last of them leaves, with each block
/// as it was when it left. So the mesh has no gaps between slices, even where a block changed after
/// its neighbour had left. When the volume returns to a place and maps it again, the new surface
/// overlaps the old one and is not connected to it.
///
/// Memory: the current piece, and 6 KB for each block with surface that left and borders on the
/// volume (for the current piece: two layers of blocks).
class MeshExtractor {
 public:
  struct Config {
    int weight_threshold = 8;   ///< voxels with no more observations than this are ignored
    double max_step_vox = 4.0;  ///< no surface where the distance changes more between neighbours

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  explicit MeshExtractor(const Config& config);
  ~MeshExtractor();

  /// The part of the mesh that a slice adds. To be called for the slices in the order in which they
  /// left.
  MeshPiece extract(const DetachedBlocks& detached);

 private:
  struct BlockEdges;
  class Pass;

  Config config_;
  std::uint32_t num_vertices_ = 0;
  /// Vertices of DetachedBlocks::bordering_coords.
  std::map<BlockCoord, std::unique_ptr<BlockEdges>> borders_;
};

}  // namespace kintsugi::mapper
