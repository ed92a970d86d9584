#pragma once
// The map of a run as files: the points that were published, and the mesh.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/extraction/mesh_extractor.hpp"
#include "mapper/output/ply_file.hpp"

namespace kintsugi::mapper {

/// The points of a run's slices: x y z nx ny nz (metres, W), red green blue, weight. 31 bytes a
/// point on disk, none in memory. Errors are those of PlyFile.
class CloudWriter {
 public:
  explicit CloudWriter(const std::filesystem::path& path);

  void append(const std::vector<CloudPoint>& points_W);
  void commit();  ///< the file is there then, and whole
  std::int64_t num_points() const { return num_points_; }

 private:
  PlyFile file_;
  std::int64_t num_points_ = 0;
};

/// The mesh of a run: vertices x y z (metres, W), red green blue; triangles counter-clockwise seen
/// from free space. 15 bytes a vertex and 13 a triangle on disk (about 21 a triangle over all),
/// none in memory. Errors are those of PlyFile.
class MeshWriter {
 public:
  explicit MeshWriter(const std::filesystem::path& path);

  /// Pieces in the order in which a MeshExtractor gave them.
  void append(const MeshPiece& piece);
  void commit();  ///< the file is there then, and whole
  std::int64_t num_triangles() const { return num_triangles_; }

 private:
  PlyFile file_;
  std::int64_t num_triangles_ = 0;
};

}  // namespace kintsugi::mapper
