#pragma once
// A cloud from a file, made ready to be segmented.

#include <filesystem>
#include <vector>

#include "segmenter/io/ply_reader.hpp"
#include "segmenter/preprocess/normals.hpp"

namespace CLI {
class App;
}

namespace kintsugi::segmenter {

struct CloudInputConfig {
  double resolution_m = 0.0;  ///< voxel size; 0: the median spacing of the points
  NormalsConfig normals;      ///< for a cloud without; its viewpoint_W is replaced
  /// Normals that come with the cloud are averaged, too, as computed ones always are.
  bool averages_given_normals = false;
  std::vector<double> viewpoint_W;  ///< that computed normals face; empty: the mean of the points

  /// Throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

/// --resolution, --normals-k, --average-normals and --viewpoint, into `config`, whose values are
/// the defaults.
void add_cloud_options(CLI::App& app, CloudInputConfig& config);

struct CloudInput {
  PlyCloud cloud;  ///< with unit normals; points that cannot be used are still in it
  float resolution_m = 0.0F;
};

/// Reads a PLY file, chooses the resolution, and computes normals where it has none, averaged
/// within twice the resolution as the mapper's are. Logs what it finds, and how many points will be
/// rejected.
/// @throws std::runtime_error as read_ply(); for a cloud without points; where the resolution is to
///   be estimated and too few points can be used
CloudInput read_cloud(const std::filesystem::path& path, const CloudInputConfig& config);

}  // namespace kintsugi::segmenter
