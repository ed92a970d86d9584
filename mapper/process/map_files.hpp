#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/extraction/mesh_extractor.hpp"
#include "mapper/output/map_writers.hpp"

namespace kintsugi::mapper {

/// The map of a run as PLY files, for those that were asked for.
///
/// Mapping does not end with a file that cannot be written (a full disk): the first failure is
/// logged, nothing remains of that file, and failed() says so in the end.
class MapFiles {
 public:
  /// Empty names: no such file. @throws std::system_error when one cannot be written
  MapFiles(const std::string& cloud, const std::string& mesh);

  void add(const std::vector<CloudSlice>& slices);

  /// To be called from one thread, which may be another than that of add(); empty when no mesh is
  /// wanted.
  std::function<void(const MeshPiece&)> mesh_sink();

  /// When nothing more is added: the files are there then, and whole.
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
