#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/extraction/mesh_extractor.hpp"
#include "mapper/output/map_writers.hpp"

namespace kintsugi::mapper {

/// The map of a run as PLY files, those of each part with a name of their own (part_file()).
///
/// Mapping continues when a file cannot be written (full disk): the first error is logged, nothing
/// remains of that file, and failed() returns true.
class MapFiles {
 public:
  /// Empty names: no such file.
  /// @throws std::system_error when a file cannot be written
  MapFiles(const std::string& cloud, const std::string& mesh);

  /// Takes the points that have left the volume; empty when there is no cloud file. To be called
  /// from one thread, which need not be that of the others.
  std::function<void(const std::vector<CloudPoint>&, const std::vector<PatchRun>&)> points_sink();
  /// The same with pieces of the mesh.
  std::function<void(const MeshPiece&, const std::vector<PatchRun>&)> mesh_sink();

  /// Completes the files, with patches where `place_of` has them; nothing can be added afterwards.
  void commit(const PlaceOfPatch& place_of = {});

  bool failed() const { return cloud_.failed || mesh_.failed; }

 private:
  template <typename Writer>
  struct Output {
    std::string path;
    std::optional<Writer> writer;
    bool failed = false;

    explicit Output(const std::string& path);
    void attempt(const std::function<void(Writer&)>& action);
  };

  Output<CloudWriter> cloud_;
  Output<MeshWriter> mesh_;
};

}  // namespace kintsugi::mapper
