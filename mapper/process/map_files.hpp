#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/extraction/mesh_extractor.hpp"
#include "mapper/output/map_writers.hpp"

namespace kintsugi::mapper {

/// The map of a run as PLY files.
///
/// Mapping continues when a file cannot be written (full disk): the first error is logged, nothing
/// remains of that file, and failed() returns true.
class MapFiles {
 public:
  /// Empty names: no such file.
  /// @throws std::system_error when a file cannot be written
  MapFiles(const std::string& cloud, const std::string& mesh);

  void add(const std::vector<CloudSlice>& slices);

  /// Takes pieces of the mesh; empty when there is no mesh file. To be called from one thread,
  /// which may differ from that of add().
  std::function<void(const MeshPiece&)> mesh_sink();

  /// Completes the files; nothing can be added afterwards.
  void commit();

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
