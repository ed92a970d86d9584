#pragma once
// Reads a cloud from a file of any format that is known, and prepares it for segmentation.

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "segmenter/io/points/file_cloud.hpp"
#include "segmenter/preprocess/normals.hpp"

namespace kintsugi::segmenter {

struct CloudInputConfig {
  double resolution_m = 0.0;  ///< voxel size; 0: the median spacing of the points
  NormalsConfig normals;      ///< for points without normals; viewpoint_W is replaced
  /// Also average the normals that the file gives, as is always done with computed ones.
  bool averages_given_normals = false;
  std::vector<double> viewpoint_W;  ///< computed normals point towards it; empty: the mean
  /// Unit of the file's coordinates: m, cm or mm; empty: the one that its header tells
  /// (unit_told_by()), else metres, with a warning where these seem wrong.
  std::string unit;
  /// Move points that are far from the origin of the file near that of W (choose_origin_W()).
  bool shifts_origin = false;
  LabelUse labels = LabelUse::kRead;  ///< of the file

  /// @throws std::invalid_argument naming field, value and bound.
  void validate() const;
};

struct CloudInput {
  FileCloud cloud;  ///< with unit normals; still contains the points that will be rejected
  float resolution_m = 0.0F;
  Eigen::Vector3d origin_W =
      Eigen::Vector3d::Zero();  ///< the file's p is metres_per(unit) p - this
  PointTable table;             ///< of all that the file says
};

/// Reads a file (read_cloud_file()), chooses the resolution, and computes missing normals: if all
/// are missing, of length 0 or NaN, they are averaged within twice the resolution like those of the
/// mapper. Logs the contents and how many points will be rejected.
/// @throws std::runtime_error as read_cloud_file() and cloud_of(), for a cloud without points or
///   without any that can be segmented, and when there are too few usable points to estimate the
///   resolution from
CloudInput read_cloud(const std::filesystem::path& path, const CloudInputConfig& config);

}  // namespace kintsugi::segmenter
