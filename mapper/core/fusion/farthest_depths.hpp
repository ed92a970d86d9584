#pragma once

#include <Eigen/Core>
#include <vector>

#include <opencv2/core.hpp>

#include "mapper/core/kernels/pinhole_camera.hpp"

namespace kintsugi::mapper {

/// The largest depths in the tiles of a depth image, to tell which blocks it cannot reach because
/// they are behind all that it shows.
class FarthestDepths {
 public:
  /// Depths beyond max_depth_m and NaN do not count.
  FarthestDepths(const cv::Mat_<float>& depth_m, const PinholeCamera& camera, float max_depth_m);

  /// The largest depth (metres) of the pixels onto which a sphere in front of the camera projects;
  /// zero where there is none. Never too small.
  float within(const Eigen::Vector3f& center_C, float radius_m) const;

 private:
  static constexpr int kSide_px = 16;

  PinholeCamera camera_;
  int num_columns_;
  int num_rows_;
  std::vector<float> farthest_m_;  ///< by tile, row by row
};

}  // namespace kintsugi::mapper
