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

  /// Takes the points of this part that have left the volume; empty when there is no cloud file. To
  /// be called from one thread, which need not be that of the others.
  std::function<void(const std::vector<CloudPoint>&, const std::vector<PatchRun>&)> points_sink();
  /// The same with pieces of the mesh.
  std::function<void(const MeshPiece&, const std::vector<PatchRun>&)> mesh_sink();

  /// Completes the files, with patches where `pose_of` has them; nothing can be added until
  /// begin_part().
  void commit(const PoseOfPatch& pose_of = {});

  /// Begins the files of another part. Never fails: see above.
  void begin_part(int part);

  bool failed() const { return cloud_.failed || mesh_.failed; }

 private:
  template <typename Writer>
  struct Output {
    std::string name;  ///< of part 0
    std::string path;  ///< of this part
    std::optional<Writer> writer;
    bool failed = false;

    explicit Output(const std::string& name);
    void attempt(const std::function<void(Writer&)>& action);
    void begin_part(int part);
    void note_failure(const std::exception& error);
  };

  Output<CloudWriter> cloud_;
  Output<MeshWriter> mesh_;
};

}  // namespace kintsugi::mapper
