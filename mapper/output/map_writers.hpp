#pragma once
// Writes the map of a run: the published points, and the mesh.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "lcmtypes/base/ply_writer.hpp"
#include "lcmtypes/messages.hpp"
#include "mapper/core/extraction/mesh_extractor.hpp"
#include "mapper/core/slices/patch_run.hpp"
#include "mapper/output/patch_runs.hpp"

namespace kintsugi::mapper {

struct WrittenFile {
  std::filesystem::path path;
  std::int64_t count = 0;  ///< of its points, or triangles
};

/// Writes the points of slices: x y z nx ny nz (metres, W), red green blue, weight. 31 bytes per
/// point on disk, none in memory. Throws like PlyWriter.
///
/// Points of patches are written in their frames P, and moved to W when the file is completed.
class CloudWriter {
 public:
  explicit CloudWriter(const std::filesystem::path& path);

  /// `runs` as PatchRuns takes them.
  void append(const std::vector<CloudPoint>& points, const std::vector<PatchRun>& runs = {});
  /// Completes the file: the points of part 0 of the map. Those of each other part get a file of
  /// their own (part_file()). Returns the files.
  std::vector<WrittenFile> commit(const PlaceOfPatch& place_of = {});

 private:
  PlyWriter file_;
  PatchRuns runs_;
};

/// Writes a mesh: vertices x y z (metres, W), red green blue; triangles counter-clockwise seen from
/// free space. 15 bytes per vertex and 13 per triangle on disk (in total about 21 per triangle),
/// none in memory. Throws like PlyWriter.
class MeshWriter {
 public:
  explicit MeshWriter(const std::filesystem::path& path);

  /// Pieces in the order in which a MeshExtractor gave them, and the patches of their vertices.
  void append(const MeshPiece& piece, const std::vector<PatchRun>& runs = {});
  /// As CloudWriter::commit().
  std::vector<WrittenFile> commit(const PlaceOfPatch& place_of = {});

 private:
  PlyWriter file_;
  PatchRuns runs_;
};

}  // namespace kintsugi::mapper
