#pragma once
// Reads a cloud from a PLY file and prepares it for segmentation.

#include <filesystem>
#include <vector>

#include "segmenter/io/ply/ply_reader.hpp"
#include "segmenter/preprocess/normals.hpp"

namespace kintsugi::segmenter {

struct CloudInputConfig {
  double resolution_m = 0.0;  ///< voxel size; 0: the median spacing of the points
  NormalsConfig normals;      ///< for a cloud without normals; viewpoint_W is replaced
  /// Also average the normals that the file gives, as is always done with computed ones.
  bool averages_given_normals = false;
  std::vector<double> viewpoint_W;  ///< computed normals point towards it; empty: the mean

  /// @throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

struct CloudInput {
  PlyCloud cloud;  ///< with unit normals; still contains the points that will be rejected
  float resolution_m = 0.0F;
};

/// Reads a PLY file, chooses the resolution, and computes missing normals, averaged within twice
/// the resolution like those of the mapper. Logs the contents and how many points will be rejected.
/// @throws std::runtime_error as read_ply(), for a cloud without points, and when there are too few
///   usable points to estimate the resolution from
CloudInput read_cloud(const std::filesystem::path& path, const CloudInputConfig& config);

}  // namespace kintsugi::segmenter
