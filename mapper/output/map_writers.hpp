#pragma once
// The map of a run as files: the points that were published, and the mesh.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lcmtypes/base/ply_writer.hpp"
#include "lcmtypes/messages.hpp"
#include "mapper/core/extraction/mesh_extractor.hpp"

namespace kintsugi::mapper {

/// The points of a run's slices: x y z nx ny nz (metres, W), red green blue, weight. 31 bytes a
/// point on disk, none in memory. Errors are those of PlyWriter.
class CloudWriter {
 public:
  explicit CloudWriter(const std::filesystem::path& path);

  void append(const std::vector<CloudPoint>& points_W);
  void commit();  ///< completes the file
  std::int64_t num_points() const;

 private:
  PlyWriter file_;
};

/// The mesh of a run: vertices x y z (metres, W), red green blue; triangles counter-clockwise seen
/// from free space. 15 bytes a vertex and 13 a triangle on disk (about 21 a triangle over all),
/// none in memory. Errors are those of PlyWriter.
class MeshWriter {
 public:
  explicit MeshWriter(const std::filesystem::path& path);

  /// Pieces in the order in which a MeshExtractor gave them.
  void append(const MeshPiece& piece);
  void commit();  ///< completes the file
  std::int64_t num_triangles() const;

 private:
  PlyWriter file_;
};

}  // namespace kintsugi::mapper
